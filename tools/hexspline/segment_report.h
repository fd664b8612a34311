/// \file segment_report.h
/// What the reports of `segment` and of `run` both say of a segmentation.
#pragma once

#include "hexspline/command.h"

#include <hex/segment/segment.h>

#include <span>

namespace cli {

Json to_json(std::span<const hex::RepairRecord> repairs);

}  // namespace cli
