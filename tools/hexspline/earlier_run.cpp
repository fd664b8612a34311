#include "hexspline/earlier_run.h"

#include <hex/base/error.h>
#include <hex/io/text_file.h>

#include <fmt/format.h>

#include <cstdint>

namespace cli {

bool is_there(const std::filesystem::path& file) {
    std::error_code unknown;
    return std::filesystem::exists(std::filesystem::symlink_status(file, unknown));
}

Json fingerprint(const std::filesystem::path& file) {
    const std::string bytes = hex::io::read_text_file(file);
    // Fowler, Noll and Vo, The FNV Non-Cryptographic Hash Algorithm, FNV-1a of 64 bits.
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const char byte : bytes) {
        hash ^= static_cast<unsigned char>(byte);
        hash *= 0x100000001b3U;
    }
    return {{"bytes", bytes.size()}, {"fnv1a", fmt::format("{:016x}", hash)}};
}

EarlierRun::EarlierRun(const std::filesystem::path& folder) : folder_(folder) {
    const std::filesystem::path file = folder / "report.json";
    if (!is_there(file)) return;
    const Json report = Json::parse(hex::io::read_text_file(file), nullptr, false);
    if (!report.is_object()) return;
    route_ = report.value("route", Json());
    const Json input_file = report.value("input_file", Json());
    if (input_file.is_object()) input_file_ = input_file;
}

std::optional<hex::Route> EarlierRun::route() const {
    for (const hex::Route route : {hex::Route::given, hex::Route::labelling, hex::Route::voxel})
        if (route_ == hex::name_of(route)) return route;
    return {};
}

void EarlierRun::require_input(const std::filesystem::path& input) const {
    if (input_file_.is_null()) return;
    for (const char* own : {"1-segment.k", "2-patches.k"}) {
        std::error_code ignored;
        if (std::filesystem::equivalent(input, folder_ / own, ignored)) return;
    }
    const std::string advice =
        "give the file that the results in " + folder_.string() +
        " were made from, or its own 1-segment.k or 2-patches.k, or leave out --from to begin anew";
    try {
        if (fingerprint(input) == input_file_) return;
    } catch (const hex::Error& error) {
        throw hex::Error(error.kind(), error.problem(), input.string(), advice);
    }
    throw hex::Error(hex::ErrorKind::usage, "is another part than the results in " + folder_.string(),
                     input.string(), advice);
}

}  // namespace cli
