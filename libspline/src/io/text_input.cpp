#include "text_input.h"

#include <hex/base/error.h>
#include <hex/io/number_text.h>

namespace spline::io {

using hex::Error;
using hex::ErrorKind;

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

}  // namespace

bool Words::skip_within_line() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    return at_ < text_.size();
}

bool Words::at_end() {
    while (skip_within_line()) {
        const bool line_begins = at_ == 0 || text_[at_ - 1] == '\n';
        if (text_[at_] == '\n') {
            ++at_;
            ++line_;
        } else if (comments_ && text_[at_] == '$' && line_begins) {
            while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        } else {
            return false;
        }
    }
    return true;
}

std::string_view Words::next(const char* wanted) {
    if (at_end()) fail(std::string("the file ends where ") + wanted + " should be");
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n') ++at_;
    return text_.substr(begin, at_ - begin);
}

std::int64_t Words::integer(const char* wanted) {
    const std::string_view word = next(wanted);
    const auto value = hex::io::parse_integer(word);
    if (!value) fail(quoted(word) + " where " + wanted + " should be");
    return *value;
}

std::size_t Words::count(const char* wanted) {
    const std::int64_t value = integer(wanted);
    if (value < 0) fail(std::to_string(value) + " where " + wanted + " should be");
    return static_cast<std::size_t>(value);
}

double Words::real(const char* wanted) {
    const std::string_view word = next(wanted);
    const auto value = hex::io::parse_double(word);
    if (!value) fail(quoted(word) + " where " + wanted + " should be");
    return *value;
}

Words::WeightedPoint Words::weighted_point() {
    WeightedPoint read;
    for (double& x : read.point) x = real("a coordinate");
    read.weight = real("a weight");
    if (!(read.weight > 0)) fail("a weight that is not positive");
    return read;
}

std::uint32_t Words::id(const char* wanted, std::size_t most) {
    const std::int64_t value = integer(wanted);
    if (value < 1 || value > static_cast<std::int64_t>(most))
        fail(std::string(wanted) + " " + std::to_string(value) + " of " + std::to_string(most) +
             " (1-based)");
    return static_cast<std::uint32_t>(value - 1);
}

void Words::keyword(const char* word) {
    const std::string_view found = next(word);
    if (found != word) fail(quoted(found) + " where " + quoted(word) + " should be");
}

void Words::fail(const std::string& what, ErrorKind kind, const std::string& advice) const {
    throw Error(kind, what, path_.string() + ":" + std::to_string(line_), advice);
}

std::string quoted(std::string_view word) {
    std::string text(1, '\'');
    text.append(word);
    text += '\'';
    return text;
}

}  // namespace spline::io
