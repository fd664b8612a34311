/// \file search_set.h
/// The search sets of surface/, which this module has known under this name.
#pragma once

#include "surface/search_set.h"
