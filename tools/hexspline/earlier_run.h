/// \file earlier_run.h
/// What an earlier `run` left in its output folder, for one that goes on there or begins anew.
#pragma once

#include "hexspline/command.h"

#include <hex/hexahedralize/hexahedralize.h>

#include <filesystem>
#include <optional>

namespace cli {

/// There is something of that name, a link that leads nowhere included.
bool is_there(const std::filesystem::path& file);

/// The size and the FNV-1a hash (64 bits) of a file: what tells one part from another. Throws
/// hex::Error{bad_input} for a file that cannot be read.
Json fingerprint(const std::filesystem::path& file);

/// The report of the last run into a folder, as far as it can be understood: hand-made folders have none, and
/// those of earlier versions tell less.
class EarlierRun {
  public:
    /// Of no run.
    EarlierRun() = default;
    /// Throws hex::Error{bad_input} for a report that cannot be read.
    explicit EarlierRun(const std::filesystem::path& folder);

    /// The route that it took.
    std::optional<hex::Route> route() const;
    /// The fingerprint of the file that the folder's surface was made from; null when that is not known.
    const Json& input_file() const { return input_file_; }
    /// Throws hex::Error{usage} when the folder's surface is known to be made from another file. Its
    /// 1-segment.k and 2-patches.k are its own.
    void require_input(const std::filesystem::path& input) const;

  private:
    std::filesystem::path folder_;
    Json route_ = nullptr;
    Json input_file_ = nullptr;
};

}  // namespace cli
