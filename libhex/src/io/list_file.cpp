#include "io/text_scanner.h"

#include <hex/base/error.h>
#include <hex/io/list_file.h>
#include <hex/io/output_file.h>

#include <climits>

namespace hex::io {
namespace {

/// A line that is not empty, split at blanks and commas.
struct Line {
    std::vector<std::string_view> words;
    std::size_t number;
};

bool separates(char c) {
    return is_blank(c) || c == ',' || c == ';';
}

/// Calls `use` with each line that holds something; `#` and `$` start a comment.
template <class Use>
void for_each_line(const InputFile& file, const Use& use) {
    std::string_view rest = file.bytes().substr(file.text_start());
    Line line{{}, 0};
    while (!rest.empty()) {
        const std::size_t end = rest.find('\n');
        std::string_view text = rest.substr(0, end);
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
        text = text.substr(0, text.find_first_of("#$"));
        line.words.clear();
        ++line.number;
        for (std::size_t i = 0; i < text.size();) {
            std::size_t j = i;
            while (j < text.size() && !separates(text[j])) ++j;
            if (j > i) line.words.push_back(text.substr(i, j - i));
            i = j + 1;
        }
        if (!line.words.empty()) use(line);
    }
}

[[noreturn]] void fail(const InputFile& file, const Line& line, const std::string& what) {
    throw Error(ErrorKind::bad_input, what, file.name() + ":" + std::to_string(line.number));
}

long long integer(const InputFile& file, const Line& line, std::size_t word, const char* what) {
    const auto value = parse_integer(line.words[word]);
    if (!value)
        fail(file, line, std::string(what) + " should be an integer, not " + in_quotes(line.words[word]));
    return *value;
}

void require_words(const InputFile& file, const Line& line, std::size_t count, const char* what) {
    if (line.words.size() != count)
        fail(file, line,
             "a line should hold " + std::string(what) + ", not " + std::to_string(line.words.size()) +
                 " values");
}

long long not_negative(const InputFile& file, const Line& line, long long value, const char* what) {
    if (value < 0) fail(file, line, std::string(what) + " " + std::to_string(value) + " is negative");
    return value;
}

int small(const InputFile& file, const Line& line, long long value, const char* what) {
    if (value < INT_MIN || value > INT_MAX)
        fail(file, line, std::string(what) + " " + std::to_string(value) + " is out of range");
    return static_cast<int>(value);
}

}  // namespace

std::vector<int> read_labels(const std::filesystem::path& path) {
    const InputFile file(path);
    std::vector<int> labels;
    for_each_line(file, [&](const Line& line) {
        require_words(file, line, 1, "one label");
        labels.push_back(small(file, line, integer(file, line, 0, "a label"), "label"));
    });
    return labels;
}

void write_labels(const std::filesystem::path& path, std::span<const int> labels) {
    OutputFile out(path);
    for (const int label : labels) {
        append_number(out.buffer(), label);
        out.buffer() += '\n';
        out.flush_if_large();
    }
    out.commit();
}

std::vector<LabelOverride> read_overrides(const std::filesystem::path& path, int base) {
    const InputFile file(path);
    std::vector<LabelOverride> overrides;
    for_each_line(file, [&](const Line& line) {
        require_words(file, line, 2, "an element and a label");
        const long long element = integer(file, line, 0, "the element");
        const int label = small(file, line, integer(file, line, 1, "the label"), "label");
        if (element < base || label < base)
            fail(file, line,
                 "element and label are counted from " + std::to_string(base) + "; found " +
                     std::to_string(element) + " " + std::to_string(label));
        overrides.push_back({element - base, label - base, static_cast<int>(line.number)});
    });
    return overrides;
}

std::vector<std::int64_t> read_sharp_vertices(const std::filesystem::path& path) {
    const InputFile file(path);
    std::vector<std::int64_t> vertices;
    for_each_line(file, [&](const Line& line) {
        for (std::size_t i = line.words.size(); i-- > 0;) {
            if (const auto value = parse_integer(line.words[i])) {
                vertices.push_back(not_negative(file, line, *value, "vertex"));
                return;
            }
        }
        fail(file, line, "the line holds no vertex index");
    });
    return vertices;
}

std::vector<std::array<std::int64_t, 2>> read_edge_list(const std::filesystem::path& path) {
    const InputFile file(path);
    std::vector<std::array<std::int64_t, 2>> edges;
    for_each_line(file, [&](const Line& line) {
        require_words(file, line, 2, "two vertices");
        const long long a = not_negative(file, line, integer(file, line, 0, "a vertex"), "vertex");
        const long long b = not_negative(file, line, integer(file, line, 1, "a vertex"), "vertex");
        edges.push_back({a, b});
    });
    return edges;
}

std::vector<std::vector<std::int64_t>> read_refinement(const std::filesystem::path& path) {
    // Every level halves the elements: deeper ones cannot be meant.
    constexpr long long deepest = 30;
    const InputFile file(path);
    std::vector<std::vector<std::int64_t>> levels;
    for_each_line(file, [&](const Line& line) {
        require_words(file, line, 2, "a level and an element");
        const long long level = not_negative(file, line, integer(file, line, 0, "the level"), "level");
        const long long element = not_negative(file, line, integer(file, line, 1, "the element"), "element");
        if (level > deepest)
            fail(file, line, "level " + std::to_string(level) + " is more than " + std::to_string(deepest));
        if (levels.size() <= static_cast<std::size_t>(level))
            levels.resize(static_cast<std::size_t>(level) + 1);
        levels[static_cast<std::size_t>(level)].push_back(element);
    });
    return levels;
}

void write_corner_list(const std::filesystem::path& path, std::span<const int> vertices,
                       std::span<const Vec3> points) {
    if (vertices.size() != points.size())
        throw Error(ErrorKind::usage, std::to_string(vertices.size()) + " corners with " +
                                          std::to_string(points.size()) + " points");
    OutputFile out(path);
    std::string& text = out.buffer();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        append_number(text, vertices[i]);
        for (int k = 0; k < 3; ++k) {
            text += ' ';
            append_number(text, points[i][k]);
        }
        text += " \n";
    }
    out.commit();
}

void write_edge_list(const std::filesystem::path& path, std::span<const std::array<int, 2>> edges) {
    OutputFile out(path);
    for (const auto& edge : edges) {
        append_number(out.buffer(), edge[0]);
        out.buffer() += ',';
        append_number(out.buffer(), edge[1]);
        out.buffer() += '\n';
    }
    out.commit();
}

void write_face_list(const std::filesystem::path& path, std::span<const std::array<int, 4>> faces) {
    OutputFile out(path);
    for (const auto& face : faces) {
        for (const int v : face) {
            append_number(out.buffer(), v);
            out.buffer() += ',';
        }
        out.buffer() += '\n';
    }
    out.commit();
}

void write_feature_lines(const std::filesystem::path& path, std::span<const Vec3> points,
                         std::span<const std::array<std::uint32_t, 2>> edges) {
    OutputFile out(path);
    std::vector<std::size_t> number(points.size(), 0);
    std::size_t used = 0;
    for (const auto& edge : edges) {
        for (const std::uint32_t v : edge) {
            if (number[v] != 0) continue;
            number[v] = ++used;
            out.buffer() += 'v';
            for (int axis = 0; axis < 3; ++axis) {
                out.buffer() += ' ';
                append_number(out.buffer(), points[v][axis]);
            }
            out.buffer() += '\n';
        }
    }
    for (const auto& [a, b] : edges) {
        out.buffer() += "l ";
        append_number(out.buffer(), number[a]);
        out.buffer() += ' ';
        append_number(out.buffer(), number[b]);
        out.buffer() += '\n';
    }
    out.commit();
}

}  // namespace hex::io
