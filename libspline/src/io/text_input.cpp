#include "text_input.h"

#include <hex/base/error.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace spline::io {

using hex::Error;
using hex::ErrorKind;

std::string read_whole(const std::filesystem::path& path) {
    std::error_code problem;
    if (std::filesystem::is_directory(path, problem))
        throw Error(ErrorKind::bad_input, "is a directory, not a BEXT file", path.string());
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file)
        throw Error(ErrorKind::bad_input, std::string("cannot be opened (") + std::strerror(errno) + ")",
                    path.string());
    std::string text(static_cast<std::size_t>(std::max<std::streamoff>(0, file.tellg())), '\0');
    file.seekg(0);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file) throw Error(ErrorKind::bad_input, "cannot be read", path.string());
    return text;
}

std::string quoted(std::string_view word) {
    std::string text(1, '\'');
    text.append(word);
    text += '\'';
    return text;
}

}  // namespace spline::io
