/// \file chain_report.h
/// What the report of `run` says of the stages up to the improved mesh.
#pragma once

#include "hexspline/command.h"

#include <hex/hexahedralize/hexahedralize.h>

namespace cli {

Json describe(const hex::HexTry& tried);
/// Of what there is of the model.
Json describe(const hex::HexModel& model);

}  // namespace cli
