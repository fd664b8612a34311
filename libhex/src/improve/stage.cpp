#include "volume/mesh_result.h"

#include <hex/base/method_call.h>
#include <hex/base/parallel.h>
#include <hex/improve/improve.h>

namespace hex {
namespace {

void check_options(const HexMesh& mesh, const ImproveOptions& options) {
    const auto refuse = [](const std::string& what, const std::string& advice) {
        throw Error(ErrorKind::usage, what, {}, advice);
    };
    if (mesh.empty())
        throw Error(ErrorKind::bad_input, "the mesh has no hexahedra", {}, "give a mesh with at least one");
    if (options.count < -1) refuse("the number of layers or sweeps is negative", "give 0 or more");
    if (!(options.step >= 0.0 && options.step <= 1.0))
        refuse("the step is not in (0, 1]", "the paper's models take 0.001 to 0.01");
    if (!(options.feature_cosine >= -1.0 && options.feature_cosine <= 1.0))
        refuse("the cosine of the feature angle is not in [-1, 1]", "the paper's rod takes 0.8");
    if (!(options.time_limit >= 0.0)) refuse("the time limit is negative", "give seconds, or 0 for none");
    if (!(options.work_limit >= 0.0)) refuse("the work limit is negative", "give evaluations, or 0 for none");
    // Also for methods that need no features.
    if (options.features == FeatureSource::list) flags_of_sharp(mesh, options.feature_vertices);
    if (!(options.target > 0.0 && options.target <= 1.0))
        refuse("the target is not in (0, 1]", "it is a scaled Jacobian; 1 means as good as possible");
}

/// Throws Error{bad_input} for what nobody could go on with.
void require_result(const ImproveResult& result, const TriangleMesh* surface, const HexMesh& mesh) {
    require_mesh(result.mesh);
    const auto vertices =
        static_cast<std::int64_t>(surface != nullptr ? surface->n_vertices() : mesh.vertex_count());
    for (const auto& edge : result.report.feature_edges)
        for (const std::int64_t v : edge)
            if (v < 0 || v >= vertices)
                throw Error(ErrorKind::bad_input, "a sharp edge has vertex " + std::to_string(v) +
                                                      ", which is not one of 0.." +
                                                      std::to_string(vertices - 1));
}

}  // namespace

Registry<Improver>& improvers() {
    static Registry<Improver> registry("improve");
    return registry;
}

ImproveResult improve(const HexMesh& mesh, const ImproveOptions& options, const Context& context) {
    const MethodCall<Improver> method(improvers(), options.method);
    check_options(mesh, options);
    const QualitySummary before = summarize(mesh, context);
    ImproveResult result = with_threads(context, [&] {
        return method([&](const Improver& improver) { return improver.improve(mesh, options, context); });
    });
    method.require("mesh", [&] { require_result(result, options.surface, mesh); });
    result.report.method = options.method;
    result.report.before = before;
    result.report.after = summarize(result.mesh, context);
    return result;
}

}  // namespace hex
