// Wavefront OBJ: vertices and polygons; texture, normals, materials and smoothing are passed over.
#include "io/formats.h"
#include "io/input_file.h"

#include <hex/base/error.h>
#include <hex/io/number_text.h>

#include <algorithm>
#include <array>
#include <map>

namespace hex::io {
namespace {

/// Our writer keeps a part id as a group of this name and the number.
constexpr std::string_view part_group = "part_";

class ObjReader {
  public:
    explicit ObjReader(const InputFile& file) : file_(file), rest_(file.bytes().substr(file.text_start())) {}

    MeshData read() {
        while (next_line()) {
            const std::string_view keyword = take_word();
            if (keyword.empty() || keyword.front() == '#') continue;
            if (keyword == "v") {
                vertex();
            } else if (keyword == "f") {
                face();
            } else if (keyword == "g" || keyword == "o") {
                group();
            } else if (!is_harmless(keyword)) {
                skipped_[std::string(keyword)].push_back(static_cast<std::int64_t>(line_number_));
            }
        }
        if (highest_ > data_.points().size())
            fail("vertex " + std::to_string(highest_) + " does not exist: the file has " +
                     std::to_string(data_.points().size()),
                 highest_line_);
        for (const auto& [word, lines] : skipped_)
            data_.warn("unknown-keyword",
                       "keyword " + in_quotes(word) + " in line " + list_ids(lines) +
                           " is not known; its data is skipped",
                       "line", lines);
        return std::move(data_);
    }

  private:
    [[noreturn]] void fail(const std::string& what, std::size_t line = 0) const {
        throw Error(ErrorKind::bad_input, what,
                    file_.name() + ":" + std::to_string(line == 0 ? line_number_ : line));
    }

    static bool is_harmless(std::string_view keyword) {
        static constexpr std::array<std::string_view, 9> names = {"vt",     "vn",     "vp",     "s", "mtllib",
                                                                  "usemtl", "usemap", "maplib", "mg"};
        return std::find(names.begin(), names.end(), keyword) != names.end();
    }

    std::string_view raw_line() {
        const std::size_t end = rest_.find('\n');
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        ++lines_read_;
        return trimmed(line);
    }

    /// The next line, joined with the ones it continues on; false at the end.
    bool next_line() {
        if (rest_.empty()) return false;
        line_ = raw_line();
        line_number_ = lines_read_;
        if (!line_.ends_with('\\')) return true;
        joined_.clear();
        while (line_.ends_with('\\')) {
            joined_.append(line_.substr(0, line_.size() - 1)) += ' ';
            if (rest_.empty()) {
                line_ = {};
                break;
            }
            line_ = raw_line();
        }
        joined_.append(line_);
        line_ = joined_;
        return true;
    }

    /// Next word of the line; empty at its end.
    std::string_view take_word() {
        std::size_t start = 0;
        while (start < line_.size() && is_blank(line_[start])) ++start;
        std::size_t end = start;
        while (end < line_.size() && !is_blank(line_[end])) ++end;
        const auto word = line_.substr(start, end - start);
        line_.remove_prefix(end);
        return word;
    }

    void vertex() {
        Vec3 point;
        for (int k = 0; k < 3; ++k) {
            const auto word = take_word();
            const auto value = parse_double(word);
            if (!value) fail("a vertex needs three finite coordinates; found " + in_quotes(word));
            point[k] = *value;
        }
        // What follows is a weight or a colour.
        data_.points().push_back(point);
    }

    void face() {
        corners_.clear();
        for (auto word = take_word(); !word.empty() && word.front() != '#'; word = take_word()) {
            const auto text = word.substr(0, word.find('/'));
            const auto value = parse_integer(text);
            if (!value || *value == 0)
                fail("a corner of a face should be a vertex index, not " + in_quotes(word));
            long long index = *value;
            if (index < 0) {
                index += static_cast<long long>(data_.points().size()) + 1;
                if (index < 1)
                    fail("vertex " + std::to_string(*value) + " reaches before the first of " +
                         std::to_string(data_.points().size()));
            }
            if (index > 0xFFFFFFFELL) fail("vertex index " + std::to_string(index) + " is too large");
            if (static_cast<std::size_t>(index) > highest_) {
                highest_ = static_cast<std::size_t>(index);
                highest_line_ = line_number_;
            }
            corners_.push_back(static_cast<std::uint32_t>(index - 1));
        }
        if (corners_.size() < 3) fail("a face with " + std::to_string(corners_.size()) + " corners");
        data_.add_polygon(corners_, part_);
    }

    void group() {
        const auto name = take_word();
        part_ = 1;
        if (!name.starts_with(part_group)) return;
        const auto number = parse_integer(name.substr(part_group.size()));
        if (number && *number >= INT32_MIN && *number <= INT32_MAX) part_ = static_cast<int>(*number);
    }

    const InputFile& file_;
    std::string_view rest_;
    std::string_view line_;
    std::string joined_;
    std::size_t lines_read_ = 0;
    std::size_t line_number_ = 0;
    MeshData data_;
    std::vector<std::uint32_t> corners_;
    int part_ = 1;
    std::size_t highest_ = 0;
    std::size_t highest_line_ = 0;
    std::map<std::string, std::vector<std::int64_t>> skipped_;
};

}  // namespace

MeshData read_obj(const InputFile& file) {
    return ObjReader(file).read();
}

void write_obj(OutputFile& out, const PolygonSoup& soup) {
    out.write("# written by hexspline\n");
    std::string& text = out.buffer();
    for (const Vec3& point : soup.points) {
        text += "v ";
        append_point(text, point);
        text += '\n';
        out.flush_if_large();
    }
    const bool groups = has_parts(soup.parts);
    for (std::size_t f = 0; f < soup.size(); ++f) {
        if (groups && (f == 0 || soup.parts[f] != soup.parts[f - 1])) {
            text += "g ";
            text += part_group;
            append_number(text, soup.parts[f]);
            text += '\n';
        }
        text += 'f';
        for (const std::uint32_t v : soup.polygon(f)) {
            text += ' ';
            append_number(text, v + std::size_t{1});
        }
        text += '\n';
        out.flush_if_large();
    }
}

}  // namespace hex::io
