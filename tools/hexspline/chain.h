/// \file chain.h
/// The stages of `run` one after the other, and their files.
#pragma once

#include "hexspline/command.h"
#include "hexspline/earlier_run.h"

#include <hex/hexahedralize/hexahedralize.h>
#include <hex/surface/mesh_types.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace cli {

/// What a stage makes stays in memory for the next one and is written to its numbered file; what was made by
/// an earlier run, or by a person, is read from there.
///
/// Patches and blocks that a person gives are mapped as they are; otherwise hex::hexahedralize makes them and
/// tries what there is to try. `route_reason` in the report tells why a route was left, `tries` what was
/// tried.
class Chain {
  public:
    explicit Chain(const CommandLine& line);

    /// Runs from --from to --to. Returns the exit code.
    int run();

  private:
    enum Stage : std::size_t { segment_stage, polycube_stage, map_stage, improve_stage, spline_stage };

    void make_folder() const;
    /// Throws Error{usage} when a stage from `first` on would write over an input.
    void require_inputs_stay(Stage first) const;
    /// The file is one that a person gave: it stays as it is.
    bool is_given(const char* option, const std::filesystem::path& file) const;
    /// Throws Error{usage} when a person's patches come without blocks.
    void require_blocks(Stage first, Stage last) const;
    /// Throws Error{bad_input} that names a result that `first` needs and neither folder nor options have.
    void require_results_before(Stage first) const;
    void choose_route(Stage first);
    /// Runs the stages that are asked for, but for the spline.
    void run_hex_stages(Stage first, Stage last);
    /// Runs `first` to `last` on the model.
    void hexahedralize(Stage first, Stage last);
    void check_given_patches();
    void load_blocks();
    void load_patches();
    void spline();
    /// Adds the time since `start` to that of a stage.
    void count_time(Stage stage, std::chrono::steady_clock::time_point start);
    void add_seconds(Stage stage, double seconds);

    void remove(const char* name) const;
    /// What an earlier run made of other results of `stage`, and its report. Patches and blocks stay: a
    /// person may have put them there.
    void remove_results_after(Stage stage) const;
    /// The patches and blocks of an earlier run, but for those that are given, where it is known to have
    /// been made from another file.
    void remove_blocks_of_another_part() const;
    /// Writes the file or files of a stage, in place of its own and those of later stages.
    void write(hex::HexStage stage, const hex::HexModel& model) const;
    Json report() const;

    const CommandLine& line_;
    std::filesystem::path folder_;
    hex::HexahedralizeOptions options_;
    hex::HexModel model_;
    EarlierRun earlier_;            ///< into the same folder
    Json input_file_ = nullptr;     ///< fingerprint of what the surface was made from, if that is known
    Json repair_ = Json::object();  ///< of the input
    Json tries_ = Json::array();
    std::string route_reason_;
    Json spline_report_ = Json::object();
    std::array<std::optional<double>, 5> seconds_;  ///< of the stages that ran
};

}  // namespace cli
