/// Prints time, elements per second and peak memory of each stage; exit code 1 when a promise is broken.
///
///     hexspline_bench                      the whole table, about a minute
///     hexspline_bench --only HexMesh       the stages whose name starts so
///     hexspline_bench --threads 1 --json bench.json

#include "stages.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

namespace {

struct Options {
    int threads = 0;
    int grid = 100;
    std::string only;
    std::string json;
};

[[noreturn]] void usage(int code) {
    (code == 0 ? std::cout : std::cerr)
        << "Usage: hexspline_bench [--threads N] [--grid N] [--only STAGE] [--json FILE|-]\n"
           "  --threads N   worker threads (default: all cores)\n"
           "  --grid N      edge of the large grid in cells (100); files are measured with half of it\n"
           "  --only STAGE  only the stages whose name starts so\n"
           "  --json FILE   the table as data, to stdout with -\n";
    std::exit(code);
}

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string name = argv[i];
        if (name == "--help" || name == "-h") usage(0);
        if (i + 1 == argc) usage(2);
        const char* text = argv[++i];
        if (name == "--threads")
            options.threads = std::atoi(text);
        else if (name == "--grid")
            options.grid = std::atoi(text);
        else if (name == "--only")
            options.only = text;
        else if (name == "--json")
            options.json = text;
        else
            usage(2);
    }
    if (options.threads < 0 || options.grid < 1) usage(2);
    return options;
}

/// Empty, or which promise is broken.
std::string verdict(const bench::Stage& stage, const bench::Measurement& measured) {
    if (!measured.problem.empty()) return measured.problem;
    if (stage.most_seconds > 0 && measured.work.seconds > stage.most_seconds) return "slower than promised";
    if (stage.most_megabytes > 0 && measured.peak_megabytes > stage.most_megabytes)
        return "more memory than promised";
    return "";
}

}  // namespace

int main(int argc, char** argv) {
    const Options options = parse(argc, argv);
    const bool table = options.json != "-";
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    bool good = true;
    if (table)
        std::printf("%-18s %-22s %10s %10s %13s %9s\n", "stage", "input", "elements", "seconds", "elements/s",
                    "peak MB");
    for (const bench::Stage& stage : bench::stages(options.threads, options.grid)) {
        if (!stage.stage.starts_with(options.only)) continue;
        const bench::Measurement measured = bench::measure(stage.body);
        const std::string problem = verdict(stage, measured);
        const auto& [elements, seconds] = measured.work;
        const double rate = seconds > 0 ? static_cast<double>(elements) / seconds : 0.0;
        good = good && problem.empty();
        rows.push_back({{"stage", stage.stage},
                        {"input", stage.input},
                        {"elements", elements},
                        {"seconds", seconds},
                        {"elements_per_second", rate},
                        {"peak_megabytes", measured.peak_megabytes},
                        {"problem", problem}});
        if (table)
            std::printf("%-18s %-22s %10zu %10.4f %13.0f %9.1f  %s\n", stage.stage.c_str(),
                        stage.input.c_str(), elements, seconds, rate, measured.peak_megabytes,
                        problem.c_str());
        std::fflush(stdout);
    }
    if (options.json == "-")
        std::cout << rows.dump(2) << '\n';
    else if (!options.json.empty())
        std::ofstream(options.json) << rows.dump(2) << '\n';
    return good ? 0 : 1;
}
