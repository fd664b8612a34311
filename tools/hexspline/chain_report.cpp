#include "hexspline/chain_report.h"

#include "hexspline/segment_report.h"

namespace cli {
namespace {

Json describe(const hex::SegmentReport& labels, int attempt) {
    return {{"charts", labels.charts},
            {"corners", labels.corners},
            {"label_corners", labels.corners},
            {"label_attempt", attempt},
            {"repairs", to_json(labels.repairs)}};
}

Json describe(const hex::BlocksReport& blocks) {
    return {{"bodies", blocks.bodies}, {"turned_shells", blocks.turned_shells},
            {"planes", blocks.planes}, {"cells", blocks.cells},
            {"unit", blocks.unit},     {"min_scaled_jacobian", blocks.min_scaled_jacobian}};
}

Json describe(const hex::VoxelReport& voxels) {
    return {{"grid", voxels.grid},
            {"cell_size", voxels.cell_size},
            {"tries", voxels.tries},
            {"repairs", voxels.repairs}};
}

Json describe(const hex::ImproveStep& step) {
    const hex::QualitySummary& before = step.report.before;
    const hex::QualitySummary& after = step.report.after;
    return {{"method", step.method},
            {"min_scaled_jacobian", {before.min, after.min}},
            {"inverted", {before.inverted, after.inverted}},
            {"work", step.report.work}};
}

}  // namespace

Json describe(const hex::HexTry& tried) {
    return {{"route", hex::name_of(tried.route)},
            {"label_attempt", tried.label_attempt ? Json(*tried.label_attempt) : Json()},
            {"blocks", tried.blocks},
            {"hexes", tried.quality.cells},
            {"inverted", tried.quality.inverted},
            {"min_scaled_jacobian", tried.quality.min},
            {"surface_distance_percent", tried.distance}};
}

Json describe(const hex::HexModel& model) {
    Json report = Json::object();
    if (model.segment_report) report.update(describe(*model.segment_report, model.label_attempt));
    if (model.blocks_report) report["block_structure"] = describe(*model.blocks_report);
    if (model.voxel_report) report["voxels"] = describe(*model.voxel_report);
    if (model.polycube) {
        report["patches"] = model.polycube->layout.patches.size();
        report["corners"] = model.polycube->corners.size();
    }
    if (model.blocks) report["blocks"] = model.blocks->cell_count();
    if (model.quality) {
        report["hexes"] = model.quality->cells;
        report["min_scaled_jacobian"] = model.quality->min;
        report["mean_scaled_jacobian"] = model.quality->mean;
        report["inverted"] = model.quality->inverted;
    }
    if (model.improved) {
        Json steps = Json::array();
        for (const auto& step : model.improve_steps) steps.push_back(describe(step));
        report["improve"] = steps;
        report["surface_distance_percent"] = model.distance;
    }
    return report;
}

}  // namespace cli
