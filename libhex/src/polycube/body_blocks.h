/// \file body_blocks.h
/// The blocks of one body, from its labelled surface.
#pragma once

#include "polycube/corner_sliding.h"

#include <hex/polycube/blocks.h>

namespace hex {

struct BodyBlocks {
    PatchedBlocks model;  ///< empty when there are errors among the violations
    BlocksReport report;  ///< charts in violations by their ids
};

/// Steps 1 to 4 of make_blocks for a closed surface that bounds one body, outwards, with part = label + 1.
/// `chart_ids` are the ids that its charts have in violations.
BodyBlocks make_body_blocks(TriangleMesh labelled, double unit, std::vector<int> chart_ids,
                            const Context& context);

}  // namespace hex
