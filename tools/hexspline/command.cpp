#include "hexspline/command.h"

#include "hexspline/console.h"
#include "hexspline/plugin_loader.h"

#include <hex/base/error.h>
#include <hex/base/version.h>
#include <hex/io/number_text.h>
#include <hex/io/output_file.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>

namespace cli {
namespace po = boost::program_options;

namespace {

std::vector<Command>& registered_commands() {
    static std::vector<Command> commands;
    return commands;
}

[[noreturn]] void usage_error(const std::string& what, const std::string& advice = {}) {
    throw hex::Error(hex::ErrorKind::usage, what, {}, advice);
}

/// "local,l" -> {"--local", "-l"}.
std::vector<std::string> spellings(const std::string& names) {
    const auto comma = names.find(',');
    std::vector<std::string> result = {"--" + names.substr(0, comma)};
    if (comma != std::string::npos) result.push_back("-" + names.substr(comma + 1));
    return result;
}

/// Where a file is or will be, whatever way leads there; nothing for what is no regular file.
std::optional<std::filesystem::path> place_of(const std::filesystem::path& path) {
    std::error_code problem;
    const auto status = std::filesystem::status(path, problem);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) return {};
    auto place = std::filesystem::weakly_canonical(std::filesystem::absolute(path, problem), problem);
    if (problem || place.empty()) return {};
    return place;
}

}  // namespace

std::vector<Command> commands() {
    auto sorted = registered_commands();
    std::sort(sorted.begin(), sorted.end(),
              [](const Command& a, const Command& b) { return a.order < b.order; });
    return sorted;
}

RegisterCommand::RegisterCommand(Command command) {
    registered_commands().push_back(std::move(command));
}

struct CommandLine::State {
    /// That an option names.
    struct File {
        std::string option;
        std::filesystem::path place;
        bool written;
    };

    State() : own("Options"), common("Common options") {}

    std::vector<File> files() const;

    po::options_description own;
    po::options_description common;
    po::positional_options_description positional;
    po::variables_map variables;
    std::vector<std::string> optional_integers;  ///< spellings of options whose value may be left out
    std::vector<std::string> output_files = {"output", "json"};  ///< options that name these
    bool has_input = false;
    std::unique_ptr<Console> console;
};

CommandLine::CommandLine(const Command& command) : command_(command), state_(std::make_unique<State>()) {
    state_->common.add_options()("threads", value<int>(), "worker threads (default: all cores)")(
        "verbose,v", po::bool_switch(), "tell what is done")("quiet,q", po::bool_switch(), "only errors")(
        "log-level", value<std::string>("LEVEL"), "trace, debug, info, warn or error")(
        "json", value<std::string>("FILE|-"), "write the report as JSON, - for stdout")(
        "plugin", value<std::vector<std::string>>("FILE")->composing(), "load a plug-in (repeatable)")(
        "help,h", po::bool_switch(), "this text");
}

CommandLine::~CommandLine() = default;

void CommandLine::add_input(const std::string& help) {
    state_->has_input = true;
    state_->own.add_options()("input,i", value<std::string>()->required(),
                              (help + " (also as plain argument, or -I)").c_str());
    state_->positional.add("input", 1);
}

void CommandLine::add_output(const std::string& help, bool required) {
    auto* semantic = value<std::string>();
    state_->own.add_options()("output,o", required ? semantic->required() : semantic, help.c_str());
}

void CommandLine::add_output_file(const std::string& names, const std::string& help) {
    add(names, value<std::string>(), help);
    state_->output_files.push_back(names.substr(0, names.find(',')));
}

void CommandLine::add(const std::string& names, const po::value_semantic* semantic, const std::string& help) {
    state_->own.add_options()(names.c_str(), semantic, help.c_str());
}

void CommandLine::add_switch(const std::string& names, const std::string& help) {
    state_->own.add_options()(names.c_str(), po::bool_switch(), help.c_str());
}

void CommandLine::add_optional_integer(const std::string& names, int implicit, const std::string& help) {
    state_->own.add_options()(names.c_str(), value<int>()->implicit_value(implicit, ""), help.c_str());
    for (auto& spelling : spellings(names)) state_->optional_integers.push_back(std::move(spelling));
}

std::vector<std::string> CommandLine::normalise(const std::vector<std::string>& arguments) const {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& argument = arguments[i];
        if (argument == "--") {
            result.insert(result.end(), arguments.begin() + static_cast<std::ptrdiff_t>(i), arguments.end());
            break;
        }
        if (state_->has_input && argument.starts_with("-I")) {
            result.push_back("-i" + argument.substr(2));
            continue;
        }
        // Boost takes the value of an option that may go without one only when it is glued to it.
        const auto& optional = state_->optional_integers;
        const bool may_have_value = std::find(optional.begin(), optional.end(), argument) != optional.end();
        if (may_have_value && i + 1 < arguments.size() && hex::io::parse_integer(arguments[i + 1])) {
            result.push_back(argument + (argument.starts_with("--") ? "=" : "") + arguments[i + 1]);
            ++i;
            continue;
        }
        result.push_back(argument);
    }
    return result;
}

bool CommandLine::parse(const std::vector<std::string>& arguments) {
    po::options_description all;
    all.add(state_->own).add(state_->common);
    namespace style = po::command_line_style;
    const auto unix_style = style::unix_style & ~style::allow_guessing;
    try {
        po::store(po::command_line_parser(normalise(arguments))
                      .options(all)
                      .positional(state_->positional)
                      .style(unix_style)
                      .run(),
                  state_->variables);
        if (get<bool>("help")) {
            std::cout << help();
            return false;
        }
        po::notify(state_->variables);
    } catch (const po::error& problem) {
        usage_error(problem.what(), "see hexspline " + command_.name + " --help");
    }
    require_values();
    require_different_files();

    ConsoleOptions console;
    console.command = command_.name;
    console.verbose = get<bool>("verbose");
    console.quiet = get<bool>("quiet");
    if (given("log-level")) console.level = get<std::string>("log-level");
    if (given("threads")) {
        console.threads = get<int>("threads");
        require_range("threads", console.threads, 1, 4096);
    }
    state_->console = std::make_unique<Console>(console);
    load_plugins(given("plugin") ? get<std::vector<std::string>>("plugin") : std::vector<std::string>());
    return true;
}

/// The files that options name, as far as it matters whether two are one: not folders, devices and pipes.
std::vector<CommandLine::State::File> CommandLine::State::files() const {
    std::vector<File> files;
    for (const auto* group : {&own, &common}) {
        for (const auto& option : group->options()) {
            const std::string& name = option->long_name();
            const auto found = variables.find(name);
            if (found == variables.end()) continue;
            const auto* text = boost::any_cast<std::string>(&found->second.value());
            const bool written =
                std::find(output_files.begin(), output_files.end(), name) != output_files.end();
            const bool is_file = written || option->format_parameter().find("FILE") != std::string::npos;
            if (text == nullptr || !is_file || *text == "-") continue;
            if (const auto place = place_of(*text)) files.push_back({name, *place, written});
        }
    }
    return files;
}

void CommandLine::require_values() const {
    for (const auto& [name, value] : state_->variables) {
        const auto* text = boost::any_cast<std::string>(&value.value());
        if (text != nullptr && text->empty() && !value.defaulted()) usage_error("--" + name + " is empty");
    }
}

void CommandLine::require_different_files() const {
    const std::vector<State::File> files = state_->files();
    for (const auto& file : files) {
        if (!file.written) continue;
        for (const auto& other : files) {
            // Each pair once. A file may be replaced by its own successor, as long as -o says so.
            if (&other == &file || (other.written && &other < &file) || file.place != other.place) continue;
            if (file.option == "output" && other.option == "input") continue;
            usage_error("--" + file.option + " and --" + other.option + " are the same file " +
                        get<std::string>(file.option));
        }
    }
}

void CommandLine::require_no_input(const std::filesystem::path& written) const {
    const auto place = place_of(written);
    for (const auto& file : state_->files())
        if (place && !file.written && file.place == *place)
            usage_error("--" + file.option + " would be overwritten: " + written.string());
}

bool CommandLine::given(const std::string& name) const {
    const auto found = state_->variables.find(name);
    return found != state_->variables.end() && !found->second.empty() && !found->second.defaulted();
}

const po::variable_value& CommandLine::variable(const std::string& name) const {
    return state_->variables[name];
}

const hex::Context& CommandLine::context() const {
    return state_->console->context();
}

void CommandLine::info(const std::string& message) const {
    state_->console->log(hex::LogLevel::info, message);
}

void CommandLine::warn(const std::string& message) const {
    state_->console->log(hex::LogLevel::warn, message);
}

void CommandLine::log(const hex::Diagnostics& diagnostics, const std::string& place) const {
    hex::log_findings(context(), diagnostics, place);
}

void CommandLine::write_report(const Json& report) const {
    if (!given("json")) return;
    Json whole = {{"command", command_.name}, {"version", hex::version}};
    if (state_->has_input) whole["input"] = input().string();
    whole.update(report);
    const std::string text = whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    const auto target = get<std::string>("json");
    if (target == "-")
        std::cout << text << std::flush;
    else
        hex::io::write_file(target, text);
}

void CommandLine::require_range(const std::string& name, double value, double lower, double upper) const {
    if (value >= lower && value <= upper) return;
    std::string text = "--" + name + " must be in [";
    hex::io::append_number(text, lower);
    text += ", ";
    hex::io::append_number(text, upper);
    text += "], not ";
    std::ostringstream number;
    number << value;
    usage_error(text + number.str());
}

std::string CommandLine::help() const {
    std::ostringstream text;
    text << "hexspline " << command_.name << ": " << command_.summary << "\n\n";
    if (!command_.description.empty()) text << command_.description << "\n\n";
    if (!command_.sample_runs.empty()) {
        text << "Sample runs:\n";
        for (const auto& run : command_.sample_runs) text << "  " << run << '\n';
        text << '\n';
    }
    text << state_->own << '\n' << state_->common;
    return text.str();
}

Json to_json(const hex::Diagnostics& diagnostics) {
    Json list = Json::array();
    for (const auto& d : diagnostics) {
        const char* severity = d.severity == hex::Severity::error     ? "error"
                               : d.severity == hex::Severity::warning ? "warning"
                                                                      : "note";
        list.push_back({{"severity", severity},
                        {"code", d.code},
                        {"message", d.message},
                        {"entity", d.entity},
                        {"ids", d.ids}});
    }
    return list;
}

}  // namespace cli
