#include "hexspline/segment_report.h"

namespace cli {

Json to_json(std::span<const hex::RepairRecord> repairs) {
    Json list = Json::array();
    for (const auto& repair : repairs)
        list.push_back({{"repair", repair.repair},
                        {"reason", repair.reason},
                        {"triangle", repair.triangle},
                        {"triangles", repair.triangles},
                        {"cost", repair.cost}});
    return list;
}

}  // namespace cli
