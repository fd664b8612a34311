/// From a surface to the mesh that is kept: what each stage leaves in the model, where a call may begin and
/// end, and what follows when labels give no blocks.

#include "support/surfaces.h"

#include <hex/base/error.h>
#include <hex/hexahedralize/hexahedralize.h>
#include <hex/quality/surface_distance.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace hex {
namespace {

TriangleMesh ball_surface() {
    return make_triangle_mesh(test::ball(6));
}

/// A quick way to a mesh: two hexahedra along each edge of a block.
HexahedralizeOptions coarse() {
    HexahedralizeOptions options;
    options.choose_size = false;
    options.map.level = 1;
    return options;
}

/// Labels that no polycube has: +X and -X are exchanged.
HexModel model_with_wrong_labels() {
    HexModel model;
    model.surface = ball_surface();
    model.segmentation = Segmentation{labels_of_parts(model.surface)};
    for (int& label : model.segmentation->labels) label = label == 0 ? 1 : label == 1 ? 0 : label;
    return model;
}

void expect_same(const HexMesh& a, const HexMesh& b) {
    ASSERT_EQ(a.vertex_count(), b.vertex_count());
    ASSERT_EQ(a.cell_count(), b.cell_count());
    for (const VertexId v : a.vertices()) EXPECT_EQ(a.position(v), b.position(v));
    EXPECT_TRUE(std::equal(a.cell_array().begin(), a.cell_array().end(), b.cell_array().begin()));
}

/// What was told last of each stage.
class Told {
  public:
    void listen(HexahedralizeOptions& options) {
        options.on_made = [this](HexStage stage, const HexModel& model) {
            order_.push_back(stage);
            last_[stage] = model;
        };
    }
    const std::vector<HexStage>& order() const { return order_; }
    const HexModel& last(HexStage stage) const { return last_.at(stage); }

    /// Who wrote down all that was told has what the call returns.
    void expect_that_it_ends_with(const HexModel& model) const {
        EXPECT_EQ(last(HexStage::segment).segmentation->labels, model.segmentation->labels);
        expect_same(*last(HexStage::polycube).blocks, *model.blocks);
        EXPECT_EQ(last(HexStage::polycube).patches.has_value(), model.patches.has_value());
        expect_same(*last(HexStage::map).mapped, *model.mapped);
        expect_same(*last(HexStage::improve).improved, *model.improved);
    }

  private:
    std::vector<HexStage> order_;
    std::map<HexStage, HexModel> last_;
};

TEST(Hexahedralize, ABoxIsABlockAndEachStageLeavesItsPart) {
    const TriangleMesh box = make_triangle_mesh(test::box_surface(2, 1, 1, 3));
    HexahedralizeOptions options;
    Told told;
    told.listen(options);
    const HexahedralizeResult result = hexahedralize(box, options);
    const HexModel& model = result.model;
    EXPECT_EQ(model.route, Route::labelling);
    EXPECT_EQ(model.segmentation->labels, labels_of_parts(box));
    EXPECT_EQ(labels_of_parts(model.surface), model.segmentation->labels);
    EXPECT_EQ(model.segment_report->charts, 6U);
    EXPECT_EQ(model.polycube->quads.size(), 6U);
    EXPECT_EQ(model.blocks_report->blocks, 1U);
    EXPECT_EQ(model.blocks->cell_count(), 1U);
    EXPECT_GE(model.mapped->cell_count(), 500U);
    EXPECT_EQ(model.improved->cell_count(), model.mapped->cell_count());
    EXPECT_EQ(model.quality->inverted, 0U);
    EXPECT_GT(model.quality->min, 0.99);
    EXPECT_LT(model.distance, 0.01);
    ASSERT_EQ(result.tries.size(), 1U);
    EXPECT_EQ(result.tries[0].quality.min, model.quality->min);
    EXPECT_EQ(result.route_reason, "");
    EXPECT_EQ(told.order(), (std::vector<HexStage>{HexStage::segment, HexStage::polycube, HexStage::map,
                                                   HexStage::map, HexStage::improve}));
    told.expect_that_it_ends_with(model);
    for (const double seconds : result.seconds) EXPECT_GT(seconds, 0.0);
}

TEST(Hexahedralize, TheReportedDistanceAndQualityAreThoseOfTheMesh) {
    const TriangleMesh ball = ball_surface();
    const HexModel model = hexahedralize(ball, coarse()).model;
    const SurfaceDistance apart = surface_distance(*model.improved, *model.patches);
    EXPECT_EQ(model.distance, apart.percent(apart.max()));
    EXPECT_EQ(model.quality->min, summarize(*model.improved).min);
}

TEST(Hexahedralize, StopsAfterAStageAndGoesOnWithTheSameResult) {
    HexModel start;
    start.surface = ball_surface();
    const HexahedralizeOptions options = coarse();
    const HexModel whole = hexahedralize(start.surface, options).model;
    for (const HexStage last : {HexStage::segment, HexStage::polycube, HexStage::map}) {
        HexModel part = hexahedralize(start, HexStage::segment, last, options).model;
        EXPECT_EQ(part.blocks.has_value(), last >= HexStage::polycube);
        EXPECT_EQ(part.mapped.has_value(), last >= HexStage::map);
        EXPECT_FALSE(part.improved);
        const auto next = static_cast<HexStage>(static_cast<int>(last) + 1);
        const HexModel rest = hexahedralize(std::move(part), next, HexStage::improve, options).model;
        expect_same(*rest.improved, *whole.improved);
    }
}

TEST(Hexahedralize, GivenPatchesAndBlocksAreKept) {
    HexModel start = hexahedralize(ball_surface(), coarse()).model;
    start.mapped.reset();
    start.improved.reset();
    HexahedralizeOptions options = coarse();
    options.route = Route::given;
    options.improve = {"smooth", "optimize"};
    const auto result = hexahedralize(start, HexStage::map, HexStage::improve, options);
    EXPECT_EQ(result.model.route, Route::given);
    expect_same(*result.model.blocks, *start.blocks);
    ASSERT_EQ(result.model.improve_steps.size(), 2U);
    EXPECT_EQ(result.model.improve_steps[0].method, "smooth");
    EXPECT_EQ(result.model.improve_steps[1].method, "optimize");
    EXPECT_EQ(result.model.improve_steps[1].report.before.min,
              result.model.improve_steps[0].report.after.min);
    EXPECT_EQ(result.tries.size(), 1U);
}

TEST(Hexahedralize, VoxelsFollowLabelsThatHaveNoPolycube) {
    const HexModel start = model_with_wrong_labels();
    HexahedralizeOptions options = coarse();
    options.map.target_hexes = 400;
    options.improve = {"snap", "smooth"};
    const auto result = hexahedralize(start, HexStage::polycube, HexStage::improve, options);
    EXPECT_EQ(result.model.route, Route::voxel);
    EXPECT_NE(result.route_reason, "");
    EXPECT_TRUE(result.model.voxel_report.has_value());
    EXPECT_FALSE(result.model.patches.has_value());
    EXPECT_EQ(result.model.quality->inverted, 0U);
    // Labels of somebody are not replaced.
    EXPECT_EQ(result.model.segmentation->labels, start.segmentation->labels);

    options.or_voxels = false;
    try {
        hexahedralize(start, HexStage::polycube, HexStage::improve, options);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::no_result);
    }
}

TEST(Hexahedralize, WhatWasToldLastIsWhatIsKept) {
    // Without improvement the sharp end leaves something to wish for; a finer mesh is tried, and is no
    // better.
    HexahedralizeOptions options;
    options.improve = {"pillow"};
    Told told;
    told.listen(options);
    const auto result = hexahedralize(ball_surface(), options);
    ASSERT_EQ(result.tries.size(), 2U);
    EXPECT_LT(result.tries[0].quality.cells, result.tries[1].quality.cells);
    EXPECT_EQ(result.model.improved->cell_count(), result.tries[0].quality.cells);
    EXPECT_EQ(result.model.quality->min, result.tries[0].quality.min);
    told.expect_that_it_ends_with(result.model);
}

TEST(Hexahedralize, TheSameForAnyNumberOfThreads) {
    Context one, three;
    one.threads = 1;
    three.threads = 3;
    const TriangleMesh surface = make_triangle_mesh(test::torus(12, 8));
    const HexahedralizeOptions options = coarse();
    const HexModel a = hexahedralize(surface, options, one).model;
    const HexModel b = hexahedralize(surface, options, three).model;
    EXPECT_EQ(a.segmentation->labels, b.segmentation->labels);
    expect_same(*a.blocks, *b.blocks);
    expect_same(*a.improved, *b.improved);
}

TEST(Hexahedralize, AModelThatLacksWhatAStageNeedsIsAnError) {
    const auto kind_of = [](HexModel model, HexStage first, Route route) {
        HexahedralizeOptions options = coarse();
        options.route = route;
        try {
            hexahedralize(std::move(model), first, HexStage::improve, options);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::quality;
    };
    HexModel bare;
    bare.surface = ball_surface();
    EXPECT_EQ(kind_of(bare, HexStage::map, Route::given), ErrorKind::usage);
    EXPECT_EQ(kind_of(bare, HexStage::improve, Route::voxel), ErrorKind::usage);
    EXPECT_EQ(kind_of(bare, HexStage::polycube, Route::given), ErrorKind::usage);
    HexModel without_patches = bare;
    without_patches.blocks = test::grid(1, 1, 1);
    EXPECT_EQ(kind_of(without_patches, HexStage::map, Route::given), ErrorKind::usage);
}

TEST(Hexahedralize, AStopThatIsAskedForEndsIt) {
    std::stop_source source;
    Context context;
    context.stop = source.get_token();
    HexahedralizeOptions options = coarse();
    options.on_made = [&](HexStage stage, const HexModel&) {
        if (stage == HexStage::polycube) source.request_stop();
    };
    try {
        hexahedralize(ball_surface(), options, context);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
}

}  // namespace
}  // namespace hex
