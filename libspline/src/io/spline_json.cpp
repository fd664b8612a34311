#include <hex/io/number_text.h>
#include <hex/io/output_file.h>
#include <spline/io/spline_json.h>

namespace spline::io {
namespace {

using hex::io::append_number;

/// `[a, b, ...]` of a range; `put` appends one item.
template <class Range, class Put>
void append_list(std::string& text, const Range& range, const Put& put) {
    text += '[';
    bool first = true;
    for (const auto& item : range) {
        if (!first) text += ',';
        first = false;
        put(item);
    }
    text += ']';
}

/// `"name": [` one item a line `]`.
template <class Put>
void write_array(hex::io::OutputFile& file, const char* name, std::size_t count, const Put& put) {
    std::string& text = file.buffer();
    text += ",\n\"";
    text += name;
    text += "\": [";
    for (std::size_t i = 0; i < count; ++i) {
        text += i == 0 ? "\n" : ",\n";
        put(i);
        file.flush_if_large();
    }
    text += "]";
}

}  // namespace

void write_spline_json(const std::filesystem::path& path, const BezierSpline& spline) {
    hex::io::OutputFile file(path);
    std::string& text = file.buffer();
    const auto number = [&](auto value) { append_number(text, value); };
    text += "{\"format\": \"hexspline spline\",\n\"version\": 1,\n\"degree\": [3, 3, 3]";
    write_array(file, "control_points", spline.function_count(), [&](std::size_t i) {
        const hex::Vec3& p = spline.control_points[i];
        append_list(text, std::array{p[0], p[1], p[2], spline.weights[i]}, number);
    });
    write_array(file, "bezier_points", spline.rows.size(), [&](std::size_t p) {
        text += '[';
        append_list(text, spline.rows[p].columns, number);
        text += ',';
        append_list(text, spline.rows[p].values, number);
        text += ']';
    });
    write_array(file, "elements", spline.element_count(),
                [&](std::size_t e) { append_list(text, spline.elements[e], number); });
    write_array(file, "level", spline.element_level.size(),
                [&](std::size_t e) { number(spline.element_level[e]); });
    write_array(file, "cell", spline.element_cell.size(),
                [&](std::size_t e) { number(spline.element_cell[e]); });
    write_array(file, "boundary_patch", spline.boundary_patch.size(),
                [&](std::size_t e) { append_list(text, spline.boundary_patch[e], number); });
    text += "\n}\n";
    file.commit();
}

}  // namespace spline::io
