/// \file error.h
/// The one exception type of the project: what is wrong, where, and what to do about it.
#pragma once

#include <stdexcept>
#include <string>

namespace hex {

/// What kind of failure an error is; the exit code of the program follows from it (exit_code()).
enum class ErrorKind {
    usage,        ///< the caller asked for something that makes no sense (exit code 2)
    bad_input,    ///< input that cannot be opened, read or understood (exit code 3)
    unsupported,  ///< understood, but not something that we can do (exit code 3)
    no_result,    ///< the algorithm found no valid result (exit code 4)
    output,       ///< output cannot be written, or memory ran out (exit code 5)
    quality,      ///< the result does not meet the asked quality (exit code 1)
    cancelled,    ///< stopped by the user (exit code 130)
};

/// Exit code of the command line program for an error of this kind (docs/cli.md).
int exit_code(ErrorKind kind);

/// Thrown by every part of the libraries for foreseeable failures. `what()` is the whole one-line message.
class Error : public std::runtime_error {
  public:
    /// \param what   what is wrong, without a trailing full stop
    /// \param where  file, `file:line`, or element ids; may be empty
    /// \param advice what the user can do; may be empty
    Error(ErrorKind kind, std::string what, std::string where = {}, std::string advice = {});

    /// The kind it was made with.
    ErrorKind kind() const { return kind_; }
    /// What is wrong: the `what` it was made with, while what() has the place and the advice, too.
    const std::string& problem() const { return problem_; }
    /// File, `file:line`, or element ids; empty when not known.
    const std::string& where() const { return where_; }
    /// What the user can do; empty when there is nothing to say.
    const std::string& advice() const { return advice_; }

    /// The same error with its place filled in, if it had none: for callers who know the file name.
    Error located(const std::string& where) const;

  private:
    ErrorKind kind_;
    std::string problem_;
    std::string where_;
    std::string advice_;
};

}  // namespace hex
