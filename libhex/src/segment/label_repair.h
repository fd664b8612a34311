/// \file label_repair.h
/// Makes a labelling that of a polycube: tries changes where it is not, keeps the best, until none is left
/// to mend or none helps.
#pragma once

#include "segment/label_energy.h"

#include <hex/base/context.h>
#include <hex/segment/segment.h>

#include <vector>

namespace hex {

struct LabelRepair {
    std::vector<int> labels;
    LabelScore score;
    std::vector<RepairRecord> repairs;
};

/// Best effort; the energy (label_energy.h) never rises. Deterministic for any number of threads. Call
/// inside with_threads.
LabelRepair repair_labels(const TriangleMesh& mesh, const LabelSurface& surface, std::vector<int> labels,
                          const Context& context);

}  // namespace hex
