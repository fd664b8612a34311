/// The binary: finds the subcommand, runs it, and turns exceptions into one line and an exit code
/// (docs/cli.md).

#include "hexspline/command.h"
#include "hexspline/console.h"

#include <hex/base/error.h>
#include <hex/base/method_call.h>
#include <hex/base/version.h>

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

namespace {

void print_help(std::ostream& out) {
    out << "hexspline " << hex::version << ": from the boundary of a solid to a volumetric spline\n\n"
        << "Usage: hexspline SUBCOMMAND [options]     (hexspline SUBCOMMAND --help tells more)\n\n";
    for (const auto& command : cli::commands())
        out << "  " << command.name << std::string(12 - command.name.size(), ' ') << command.summary << '\n';
    out << "\n  -h, --help    this text\n      --version the version\n";
}

int run_command(const cli::Command& command, const std::vector<std::string>& arguments) {
    cli::CommandLine line(command);
    command.describe(line);
    return line.parse(arguments) ? command.run(line) : 0;
}

/// One line, whatever the message holds: that of a plug-in may have several.
int report(const std::string& command, std::string message, int code) {
    for (char& c : message)
        if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
    std::cerr << "hexspline" << (command.empty() ? "" : " " + command) << ": error: " << message << '\n';
    return code;
}

/// Runs `work` and turns what it throws into one line and an exit code.
template <class Work>
int guarded(const std::string& name, const Work& work) {
    try {
        return work();
    } catch (const hex::Error& error) {
        if (error.kind() == hex::ErrorKind::cancelled && !cli::may_tell_of_interruption())
            return hex::exit_code(error.kind());
        return report(name, error.what(), hex::exit_code(error.kind()));
    } catch (const std::exception& problem) {
        if (hex::is_out_of_memory_or_threads(problem))
            return report(name, cli::out_of_memory_or_threads, hex::exit_code(hex::ErrorKind::output));
        return report(name, "internal error: " + hex::message_of(problem),
                      hex::exit_code(hex::ErrorKind::no_result));
    } catch (...) {
        // A plug-in may throw anything.
        return report(name, "internal error: an exception of unknown kind",
                      hex::exit_code(hex::ErrorKind::no_result));
    }
}

/// The exit code of a command that has done its work, which may be just when it was told to stop.
int unless_interrupted(const std::string& name, int code) {
    const int cancelled = hex::exit_code(hex::ErrorKind::cancelled);
    if (code == cancelled || !cli::interrupted()) return code;
    return cli::may_tell_of_interruption() ? report(name, "interrupted", cancelled) : cancelled;
}

int dispatch(const std::vector<std::string>& arguments) {
    if (arguments.empty()) {
        print_help(std::cerr);
        return 2;
    }
    const std::string& name = arguments.front();
    if (name == "-h" || name == "--help" || name == "help") {
        print_help(std::cout);
        return 0;
    }
    if (name == "--version") {
        std::cout << "hexspline " << hex::version << '\n';
        return 0;
    }
    for (const auto& command : cli::commands()) {
        if (command.name != name) continue;
        return guarded(name, [&] {
            return unless_interrupted(name, run_command(command, {arguments.begin() + 1, arguments.end()}));
        });
    }
    return report("", "unknown subcommand '" + name + "'; see hexspline --help", 2);
}

}  // namespace

int main(int argc, char** argv) {
    cli::end_well_whatever_is_thrown();
    const int code = guarded("", [&] {
        cli::watch_interrupts(argc > 1 ? argv[1] : "");
        return dispatch({argv + 1, argv + argc});
    });
    std::cout.flush();
    // A result that could not be printed is a result that was not delivered.
    if (code == 0 && !std::cout)
        return report("", "stdout cannot be written", hex::exit_code(hex::ErrorKind::output));
    return code;
}
