#include <hex/base/error.h>

namespace hex {
namespace {

std::string one_line(const std::string& what, const std::string& where, const std::string& advice) {
    std::string line;
    if (!where.empty()) line += where + ": ";
    line += what;
    if (!advice.empty()) line += "; " + advice;
    for (char& c : line) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    return line;
}

}  // namespace

int exit_code(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::usage:
            return 2;
        case ErrorKind::bad_input:
        case ErrorKind::unsupported:
            return 3;
        case ErrorKind::no_result:
            return 4;
        case ErrorKind::output:
            return 5;
        case ErrorKind::quality:
            return 1;
        case ErrorKind::cancelled:
            return 130;
    }
    return 3;
}

Error::Error(ErrorKind kind, std::string what, std::string where, std::string advice)
    : std::runtime_error(one_line(what, where, advice)),
      kind_(kind),
      problem_(std::move(what)),
      where_(std::move(where)),
      advice_(std::move(advice)) {}

Error Error::located(const std::string& where) const {
    return where_.empty() ? Error(kind_, problem_, where, advice_) : *this;
}

}  // namespace hex
