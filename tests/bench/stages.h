/// \file stages.h
/// What is measured.
#pragma once

#include "measurement.h"

#include <string>
#include <vector>

namespace bench {

struct Stage {
    std::string stage;  ///< the name it has everywhere
    std::string input;  ///< what it is measured on
    std::function<Work()> body;
    double most_seconds = 0.0;    ///< promised; 0 = nothing promised
    double most_megabytes = 0.0;  ///< promised; 0 = nothing promised
};

/// \param grid edge length of the large grid in cells
std::vector<Stage> stages(int threads, int grid);

}  // namespace bench
