/// Sample runs:
///   hexspline plugins
///   hexspline plugins --plugin build/release/lib/axis_segmenter.so

#include "hexspline/command.h"

#include <hex/improve/improve.h>
#include <hex/io/reader.h>
#include <hex/map/map.h>
#include <hex/polycube/polycube.h>
#include <hex/segment/segment.h>
#include <spline/spline.h>

#include <iostream>

namespace cli {
namespace {

std::vector<hex::MethodInfo> all_methods() {
    std::vector<hex::MethodInfo> methods;
    const auto add = [&](const std::vector<hex::MethodInfo>& of_stage) {
        methods.insert(methods.end(), of_stage.begin(), of_stage.end());
    };
    add(hex::segmenters().list());
    add(hex::polycube_builders().list());
    add(hex::mappers().list());
    add(hex::improvers().list());
    add(spline::spline_builders().list());
    add(hex::io::readers().list());
    return methods;
}

int run(CommandLine& line) {
    Json report = Json::array();
    for (const auto& method : all_methods()) {
        report.push_back({{"stage", method.stage},
                          {"method", method.name},
                          {"description", method.description},
                          {"origin", method.origin}});
        // With --json - the report is what was asked for on stdout.
        if (line.get_or<std::string>("json", "") == "-") continue;
        const auto padded = [](const std::string& text, std::size_t width) {
            return text + std::string(width > text.size() ? width - text.size() : 0, ' ') + ' ';
        };
        std::cout << padded(method.stage, 9) << padded(method.name, 12) << padded(method.origin, 10)
                  << method.description << '\n';
    }
    line.write_report({{"methods", report}});
    return 0;
}

const RegisterCommand registered({.name = "plugins",
                                  .order = 90,
                                  .summary = "list every method of every stage and where it comes from",
                                  .sample_runs = {"hexspline plugins",
                                                  "hexspline plugins --plugin axis_segmenter.so --json -"},
                                  .describe = [](CommandLine&) {},
                                  .run = run});

}  // namespace
}  // namespace cli
