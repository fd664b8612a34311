/// \file command.h
/// What all subcommands share. A subcommand is one file in commands/: it registers itself, parses its
/// options, calls the library, writes and prints. No geometry in here.
///
///     int run(CommandLine& line) {
///         const hex::TriangleMesh mesh = load_triangles(line, line.input());
///         hex::SegmentOptions options;
///         options.boundary_weight = line.get<double>("weight");
///         const auto result = hex::segment(mesh, options, line.context());
///         hex::io::write_surface(line.output(), ...);
///         line.write_report({{"label_counts", ...}});
///         return 0;
///     }
///     const RegisterCommand registered({
///         .name = "segment", .order = 10, .summary = "label the triangles ...",
///         .sample_runs = {"hexspline segment -i part.stl -o part_segment.k"},
///         .describe = [](CommandLine& line) { line.add_input(); line.add_output(); line.add("weight,l",
///         value<double>()->default_value(0.1), "..."); }, .run = run});
#pragma once

#include <hex/base/context.h>
#include <hex/base/diagnostics.h>

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace cli {

using Json = nlohmann::ordered_json;

/// Value of an option, with a default shown in the help text. Shorthands for Boost.Program_options.
template <class T>
boost::program_options::typed_value<T>* value() {
    return boost::program_options::value<T>()->value_name(std::is_same_v<T, std::string> ? "FILE" : "N");
}
/// With a name for the value, e.g. value<std::string>("NAME").
template <class T>
boost::program_options::typed_value<T>* value(const char* value_name) {
    return boost::program_options::value<T>()->value_name(value_name);
}

class CommandLine;

struct Command {
    std::string name;
    int order = 0;                         ///< place in the list of `hexspline --help`
    std::string summary;                   ///< one line
    std::string description = {};          ///< more lines for `hexspline NAME --help`
    std::vector<std::string> sample_runs;  ///< command lines shown in the help text
    std::function<void(CommandLine&)> describe;
    std::function<int(CommandLine&)> run;
};

/// All subcommands in their order.
std::vector<Command> commands();

/// A static object of this type registers a subcommand.
struct RegisterCommand {
    explicit RegisterCommand(Command command);
};

/// The options of one subcommand: declared, then parsed, then asked.
class CommandLine {
  public:
    explicit CommandLine(const Command& command);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// -i/-I/--input or the one positional argument; required.
    void add_input(const std::string& help);
    /// -o/--output; required unless `required` is false.
    void add_output(const std::string& help, bool required = true);
    /// A file besides that is written. parse() refuses one that is another such file, the output, or an
    /// input.
    void add_output_file(const std::string& names, const std::string& help);
    /// Any other option: "long,s" as in Boost.Program_options. With FILE in the name of its value it names an
    /// input.
    void add(const std::string& names, const boost::program_options::value_semantic* semantic,
             const std::string& help);
    /// A switch.
    void add_switch(const std::string& names, const std::string& help);
    /// An option whose value may be left out (`-l`, `-l 2`, `--local=2`): without one it has the value
    /// `implicit`. Only an integer is taken as its value.
    void add_optional_integer(const std::string& names, int implicit, const std::string& help);

    /// Parses. Returns false when help was asked for and printed. Throws hex::Error{usage}.
    bool parse(const std::vector<std::string>& arguments);

    /// The option was given on the command line (a default does not count).
    bool given(const std::string& name) const;
    template <class T>
    T get(const std::string& name) const {
        return variable(name).as<T>();
    }
    /// The value when given, else `otherwise`.
    template <class T>
    T get_or(const std::string& name, T otherwise) const {
        return given(name) ? get<T>(name) : otherwise;
    }
    bool is_set(const std::string& switch_name) const { return get<bool>(switch_name); }

    std::filesystem::path input() const { return get<std::string>("input"); }
    std::filesystem::path output() const { return get<std::string>("output"); }

    const std::string& name() const { return command_.name; }
    /// Threads, progress, cancel and log as the common options say.
    const hex::Context& context() const;

    /// Messages on stderr; `info` shows with -v.
    void info(const std::string& message) const;
    void warn(const std::string& message) const;
    /// Logs findings: errors and warnings as warnings, notes as info. `place` (a file name) is put in front
    /// when given.
    void log(const hex::Diagnostics& diagnostics, const std::string& place = {}) const;

    /// Writes the stage's report to where --json says, with `command`, `version` and `input` in front;
    /// nothing without --json. An option --json that equals another output file, or the input, is an error.
    void write_report(const Json& report) const;

    /// Throws Error{usage} when a file that is to be written without being named by an option is an input.
    void require_no_input(const std::filesystem::path& written) const;

    /// Throws Error{usage} when the named option's value is outside [lower, upper].
    void require_range(const std::string& name, double value, double lower, double upper) const;

    std::string help() const;

  private:
    const boost::program_options::variable_value& variable(const std::string& name) const;
    void require_values() const;
    void require_different_files() const;
    std::vector<std::string> normalise(const std::vector<std::string>& arguments) const;

    struct State;
    Command command_;
    std::unique_ptr<State> state_;
};

/// Findings as JSON: a list of {severity, code, message, entity, ids}.
Json to_json(const hex::Diagnostics& diagnostics);

}  // namespace cli
