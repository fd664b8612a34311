// Reads legacy VTK files, versions 1 to 5.1, ASCII and binary: unstructured grids and poly data.
#include "io/formats.h"
#include "io/legacy_vtk_numbers.h"
#include "io/vtk_cells.h"

#include <hex/base/error.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace hex::io {
namespace {

using Type = LegacyVtkNumbers::Type;

class LegacyVtkReader {
  public:
    explicit LegacyVtkReader(const InputFile& file) : numbers_(file), scanner_(numbers_.scanner()) {}

    MeshData read() {
        header();
        while (!scanner_.at_end() && !stopped_) section(upper_case(scanner_.word("a keyword")));
        if (!has_points_) scanner_.fail("the file has no POINTS");
        if (grid_)
            finish_grid();
        else
            finish_poly_data();
        return std::move(data_);
    }

  private:
    /// Cells of one of the sections of poly data, or of CELLS.
    struct Rows {
        std::vector<std::size_t> offsets = {0};
        std::vector<std::uint32_t> corners;
        std::size_t size() const { return offsets.size() - 1; }
    };
    static constexpr std::array<std::string_view, 4> poly_sections = {"VERTICES", "LINES", "POLYGONS",
                                                                      "TRIANGLE_STRIPS"};
    static constexpr std::array<int, 4> poly_types = {2, 4, vtk_polygon, 6};

    void header() {
        const std::string first = lower_case(scanner_.rest_of_line());
        if (!first.starts_with("# vtk datafile version"))
            throw Error(ErrorKind::bad_input,
                        "not a legacy VTK file: it does not start with '# vtk DataFile Version'",
                        scanner_.file().line_place(0));
        scanner_.rest_of_line();
        const std::string encoding = upper_case(scanner_.word("ASCII or BINARY"));
        if (encoding != "ASCII" && encoding != "BINARY")
            scanner_.fail("ASCII or BINARY should be here, not " + in_quotes(encoding));
        numbers_.set_binary(encoding == "BINARY");
        if (upper_case(scanner_.word("DATASET")) != "DATASET") scanner_.fail("DATASET should be here");
        const std::string kind = upper_case(scanner_.word("the kind of data set"));
        if (kind != "UNSTRUCTURED_GRID" && kind != "POLYDATA")
            scanner_.unsupported("the data set is a " + in_quotes(kind),
                                 "UNSTRUCTURED_GRID and POLYDATA can be read");
        grid_ = kind == "UNSTRUCTURED_GRID";
    }

    void section(const std::string& keyword) {
        if (keyword == "POINTS") return points();
        if (grid_ && keyword == "CELLS") return rows(cells_);
        if (grid_ && keyword == "CELL_TYPES") return cell_types();
        if (!grid_) {
            for (std::size_t i = 0; i < poly_sections.size(); ++i) {
                if (keyword == poly_sections[i]) return rows(poly_[i]);
            }
        }
        if (keyword == "CELL_DATA" || keyword == "POINT_DATA") {
            on_cells_ = keyword == "CELL_DATA";
            tuples_ = scanner_.count("the number of tuples", 1);
            const std::size_t expected = on_cells_ ? cell_count() : data_.points().size();
            if (tuples_ != expected)
                scanner_.fail(keyword + " is for " + std::to_string(tuples_) +
                              (on_cells_ ? " cells of " : " points of ") + std::to_string(expected));
            return;
        }
        if (keyword == "METADATA") return metadata();
        if (keyword == "FIELD") return field();
        if (attribute(keyword)) return;
        if (has_points_ && cell_count() > 0) {
            data_.warn("unknown-keyword",
                       in_quotes(keyword) + " is not known; the rest of the file is skipped", "line",
                       {line_number()});
            stopped_ = true;
            return;
        }
        scanner_.fail("unknown keyword " + in_quotes(keyword));
    }

    std::int64_t line_number() const {
        const std::string place = scanner_.place();
        return parse_integer(place.substr(place.rfind(':') + 1)).value_or(0);
    }

    std::size_t cell_count() const {
        std::size_t count = cells_.size();
        for (const Rows& section : poly_) count += section.size();
        return count;
    }

    // --- geometry ---

    void points() {
        if (has_points_) scanner_.fail("POINTS a second time");
        const std::size_t count = scanner_.count("the number of points", numbers_.binary() ? 3 : 6);
        numbers_.start_array(3 * count, numbers_.type());
        has_points_ = true;
        auto& points = data_.points();
        if (!numbers_.binary()) {
            points.resize(count);
            if (count > 0 && numbers_.take_numbers(std::span(points.front().data(), 3 * count))) return;
            points.clear();
        }
        points.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double x = numbers_.next_real();
            const double y = numbers_.next_real();
            const double z = numbers_.next_real();
            points.emplace_back(x, y, z);
            if (numbers_.binary() && !points.back().allFinite())
                numbers_.fail_binary("point " + std::to_string(i) + " has a coordinate that is not finite");
        }
    }

    std::uint32_t next_corner() {
        const long long v = numbers_.next_integer();
        if (v < 0 || v >= static_cast<long long>(data_.points().size()))
            numbers_.fail_value("point index " + std::to_string(v) + " is not in 0.." +
                                std::to_string(static_cast<long long>(data_.points().size()) - 1));
        return static_cast<std::uint32_t>(v);
    }

    void rows(Rows& result) {
        if (!has_points_) scanner_.fail("POINTS must come before the cells");
        if (result.size() > 0) scanner_.fail("this section is there a second time");
        const std::size_t count = scanner_.count("the number of cells", 1);
        const std::size_t size = scanner_.count("the size of the cell list", 1);
        if (upper_case(scanner_.peek()) == "OFFSETS") return rows_with_offsets(result, count, size);
        if (count > size)
            scanner_.fail(std::to_string(count) + " cells do not fit into a list of " + std::to_string(size) +
                          " numbers");
        numbers_.start_array(size, Type::int32);
        if (take_rows(result, count, size)) return;
        result.offsets.reserve(count + 1);
        result.corners.reserve(size - count);
        std::size_t left = size;
        for (std::size_t c = 0; c < count; ++c) {
            const long long corners = left > 0 ? numbers_.next_integer() : 0;
            if (corners < 1 || static_cast<unsigned long long>(corners) > left - 1)
                numbers_.fail_value("cell " + std::to_string(c) + " with " + std::to_string(corners) +
                                    " corners does not fit into the list of " + std::to_string(size) +
                                    " numbers");
            left -= static_cast<std::size_t>(corners) + 1;
            for (long long i = 0; i < corners; ++i) result.corners.push_back(next_corner());
            result.offsets.push_back(result.corners.size());
        }
        if (left > 0)
            numbers_.fail_value("the cells leave " + std::to_string(left) + " numbers of their list unused");
    }

    /// The rows of a text file in one go; false, and nothing taken, when something about them is wrong: then
    /// they are read one by one, which finds out what and where.
    bool take_rows(Rows& result, std::size_t count, std::size_t size) {
        if (numbers_.binary()) return false;
        const std::size_t start = scanner_.position();
        std::vector<std::uint32_t> numbers(size);
        if (!numbers_.take_numbers(std::span(numbers))) return false;
        Rows rows;
        rows.offsets.reserve(count + 1);
        const std::size_t points = data_.points().size();
        // The corners move up to where the sizes of the rows were.
        std::size_t next = 0, kept = 0;
        for (std::size_t c = 0; c < count; ++c) {
            const std::size_t corners = next < size ? numbers[next++] : 0;
            bool good = corners >= 1 && corners <= size - next;
            for (std::size_t i = 0; good && i < corners; ++i) {
                good = numbers[next] < points;
                numbers[kept++] = numbers[next++];
            }
            if (!good) {
                scanner_.seek(start);
                return false;
            }
            rows.offsets.push_back(kept);
        }
        if (next != size) {
            scanner_.seek(start);
            return false;
        }
        numbers.resize(kept);
        rows.corners = std::move(numbers);
        result = std::move(rows);
        return true;
    }

    /// The layout since version 5: offsets of all cells, then corners of all cells.
    void rows_with_offsets(Rows& result, std::size_t count, std::size_t size) {
        scanner_.word("OFFSETS");
        Type offsets_type = numbers_.type();
        numbers_.require_integers(offsets_type);
        numbers_.start_array(count, offsets_type);
        result.offsets.clear();
        result.offsets.reserve(count + 1);
        for (std::size_t i = 0; i < count; ++i) {
            const long long offset = numbers_.next_integer();
            const long long before = i == 0 ? 0 : static_cast<long long>(result.offsets.back());
            if (offset < before || (i == 0 && offset != 0) || offset > static_cast<long long>(size))
                numbers_.fail_value("offset " + std::to_string(offset) + " of cell " + std::to_string(i) +
                                    " does not follow " + std::to_string(before));
            result.offsets.push_back(static_cast<std::size_t>(offset));
        }
        if (count == 0) result.offsets.push_back(0);
        if (result.offsets.back() != size)
            numbers_.fail_value("the offsets end at " + std::to_string(result.offsets.back()) + ", not at " +
                                std::to_string(size));
        if (upper_case(scanner_.word("CONNECTIVITY")) != "CONNECTIVITY")
            scanner_.fail("CONNECTIVITY should be here");
        const Type corners_type = numbers_.type();
        numbers_.require_integers(corners_type);
        numbers_.start_array(size, corners_type);
        result.corners.reserve(size);
        for (std::size_t i = 0; i < size; ++i) result.corners.push_back(next_corner());
    }

    void cell_types() {
        const std::size_t count = scanner_.count("the number of cell types", 1);
        if (count != cells_.size())
            scanner_.fail(std::to_string(count) + " cell types for " + std::to_string(cells_.size()) +
                          " cells");
        numbers_.start_array(count, Type::int32);
        std::vector<std::uint32_t> numbers(numbers_.binary() ? 0 : count);
        if (!numbers_.binary() && numbers_.take_numbers(std::span(numbers)) &&
            std::all_of(numbers.begin(), numbers.end(), [](std::uint32_t type) { return type <= 255; })) {
            types_.assign(numbers.begin(), numbers.end());
            return;
        }
        types_.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const long long value = numbers_.next_integer();
            if (value < 0 || value > 255)
                numbers_.fail_value("cell type " + std::to_string(value) + " does not exist");
            types_.push_back(static_cast<int>(value));
        }
    }

    // --- attributes: all are skipped but a cell scalar of part ids ---

    void values(const std::string& name, Type type, std::size_t components, std::size_t tuples) {
        if (components != 0 && tuples > std::numeric_limits<std::size_t>::max() / components)
            scanner_.fail("too many values");
        const std::size_t count = components * tuples;
        numbers_.start_array(count, type);
        const bool wanted =
            on_cells_ && components == 1 && tuples == cell_count() && parts_.empty() && names_part_ids(name);
        if (wanted && type != Type::bit) {
            std::vector<double> part_values(count);
            for (double& value : part_values) value = numbers_.next_real();
            if (auto parts = to_parts(part_values))
                parts_ = std::move(*parts);
            else
                data_.warn("part-ids-skipped",
                           "cell field " + in_quotes(name) +
                               " holds values that are no integers of 32 bits: part ids skipped");
        } else {
            numbers_.skip_array(count);
        }
    }

    bool attribute(const std::string& keyword) {
        const auto name = [&] { return std::string(scanner_.word("a name")); };
        if (keyword == "SCALARS") {
            const std::string field_name = name();
            const Type field_type = numbers_.type();
            const std::string_view rest = scanner_.rest_of_line();
            std::size_t components = 1;
            if (!rest.empty()) {
                const auto value = parse_integer(rest);
                if (!value || *value < 1 || *value > 4)
                    scanner_.fail("the number of components should be 1 to 4, not " + in_quotes(rest));
                components = static_cast<std::size_t>(*value);
            }
            // The lookup table is not optional, but some files have none.
            if (upper_case(scanner_.peek()) == "LOOKUP_TABLE") {
                scanner_.word("LOOKUP_TABLE");
                name();
            } else {
                // Back to the end of the line, where an array starts.
                scanner_.seek(scanner_.position() - 1);
            }
            values(field_name, field_type, components, tuples_);
            return true;
        }
        if (keyword == "LOOKUP_TABLE") {
            name();
            values("", numbers_.binary() ? Type::uint8 : Type::float32, 4,
                   scanner_.count("the size of the table", 4));
            return true;
        }
        if (keyword == "COLOR_SCALARS") {
            name();
            values("", numbers_.binary() ? Type::uint8 : Type::float32,
                   scanner_.count("the number of components", 1), tuples_);
            return true;
        }
        if (keyword == "TEXTURE_COORDINATES") {
            name();
            const std::size_t components = scanner_.count("the dimension", 1);
            values("", numbers_.type(), components, tuples_);
            return true;
        }
        const std::size_t components =
            keyword == "VECTORS" || keyword == "NORMALS"                                      ? 3
            : keyword == "TENSORS"                                                            ? 9
            : keyword == "TENSORS6"                                                           ? 6
            : keyword == "GLOBAL_IDS" || keyword == "PEDIGREE_IDS" || keyword == "EDGE_FLAGS" ? 1
                                                                                              : 0;
        if (components == 0) return false;
        name();
        values("", numbers_.type(), components, tuples_);
        return true;
    }

    void field() {
        scanner_.word("a name");
        const std::size_t arrays = scanner_.count("the number of arrays", 1);
        for (std::size_t i = 0; i < arrays; ++i) {
            while (upper_case(scanner_.peek()) == "METADATA") {
                scanner_.word("METADATA");
                metadata();
            }
            const std::string array_name(scanner_.word("the name of an array"));
            const std::size_t components = scanner_.count("the number of components", 1);
            const std::size_t tuples = scanner_.count("the number of tuples", 1);
            if (lower_case(scanner_.peek()) == "string") {
                if (numbers_.binary()) scanner_.unsupported("binary arrays of strings are not supported");
                scanner_.word("string");
                scanner_.rest_of_line();
                for (std::size_t s = 0; s < components * tuples && !scanner_.at_end(); ++s)
                    scanner_.rest_of_line();
                continue;
            }
            values(array_name, numbers_.type(), components, tuples);
        }
    }

    /// Everything up to an empty line.
    void metadata() {
        scanner_.rest_of_line();
        while (scanner_.position() < scanner_.text().size() && !scanner_.rest_of_line().empty()) {
        }
    }

    // --- the result ---

    void finish_grid() {
        if (types_.size() != cells_.size()) scanner_.fail("the file ends before CELL_TYPES");
        append_cells(data_, {std::move(types_), std::move(cells_.offsets), std::move(cells_.corners)}, parts_,
                     scanner_.file().name());
    }

    void finish_poly_data() {
        VtkCells all;
        for (std::size_t s = 0; s < poly_.size(); ++s) {
            for (std::size_t c = 0; c < poly_[s].size(); ++c) {
                all.types.push_back(poly_types[s]);
                all.offsets.push_back(all.corners.size() + poly_[s].offsets[c + 1]);
            }
            all.corners.insert(all.corners.end(), poly_[s].corners.begin(), poly_[s].corners.end());
        }
        append_cells(data_, all, parts_, scanner_.file().name());
    }

    LegacyVtkNumbers numbers_;
    TextScanner& scanner_;
    MeshData data_;
    bool grid_ = false;
    bool has_points_ = false;
    bool stopped_ = false;
    bool on_cells_ = false;
    std::size_t tuples_ = 0;
    Rows cells_;
    std::array<Rows, 4> poly_;
    std::vector<int> types_;
    std::vector<int> parts_;
};

}  // namespace

MeshData read_legacy_vtk(const InputFile& file) {
    return LegacyVtkReader(file).read();
}

}  // namespace hex::io
