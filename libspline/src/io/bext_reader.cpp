#include "text_input.h"

#include <hex/base/error.h>
#include <hex/io/text_file.h>
#include <spline/io/bext.h>
#include <spline/io/bext2.h>

#include <algorithm>
#include <bitset>
#include <string>
#include <string_view>

namespace spline::io {
namespace {

using hex::ErrorKind;

class Reader {
  public:
    Reader(const std::filesystem::path& path, std::string_view text) : words_(path, text, false) {}

    BezierSpline read() {
        read_head();
        while (!words_.at_end()) {
            const std::string_view word = words_.next("gnode or belem");
            if (word == "gnode")
                read_node();
            else if (word == "belem")
                read_element();
            else
                words_.fail("unknown keyword " + quoted(word), ErrorKind::bad_input,
                            "gnode and belem are known");
        }
        if (spline_.control_points.size() != nodes_)
            words_.fail("nodeN says " + std::to_string(nodes_) + " control points, there are " +
                        std::to_string(spline_.control_points.size()));
        if (spline_.elements.size() != elements_)
            words_.fail("elemN says " + std::to_string(elements_) + " elements, there are " +
                        std::to_string(spline_.elements.size()));
        spline_.element_level.assign(elements_, 0);
        spline_.element_cell.resize(elements_);
        for (std::size_t e = 0; e < elements_; ++e) spline_.element_cell[e] = static_cast<std::uint32_t>(e);
        return std::move(spline_);
    }

  private:
    void read_head() {
        if (words_.at_end()) words_.fail("is empty, not a BEXT file");
        for (const char* letter : {"B", "E", "X", "T"}) {
            if (words_.next("B E X T") != letter)
                words_.fail("is not a BEXT file: it does not start with 'B E X T'");
        }
        const std::string_view word = words_.next("type");
        if (word != "type") words_.fail(quoted(word) + " where 'type' should be");
        const std::string_view type = words_.next("hex");
        if (type != "hex")
            words_.fail("elements of type " + quoted(type), ErrorKind::unsupported,
                        "only type hex can be read");
        words_.keyword("nodeN");
        nodes_ = words_.count("the number of control points");
        words_.keyword("elemN");
        elements_ = words_.count("the number of elements");
        if (elements_ == 0) words_.fail("has no elements");
        // A header that lies must not make us ask for more memory than the file could fill.
        spline_.control_points.reserve(std::min(nodes_, words_.bytes_left() / 13));
        spline_.weights.reserve(spline_.control_points.capacity());
        spline_.elements.reserve(std::min(elements_, words_.bytes_left() / 64));
    }

    void read_node() {
        if (!spline_.elements.empty()) words_.fail("gnode after the first belem");
        const auto [point, weight] = words_.weighted_point();
        spline_.control_points.push_back(point);
        spline_.weights.push_back(weight);
        if (spline_.control_points.size() > nodes_) words_.fail("more control points than nodeN says");
    }

    void read_element() {
        const std::size_t functions = words_.count("the number of functions");
        for (int a = 0; a < 3; ++a) {
            if (words_.count("a degree") != 3)
                words_.fail("elements of another degree than 3", ErrorKind::unsupported);
        }
        functions_.clear();
        last_element_of_.resize(spline_.control_points.size());
        for (std::size_t i = 0; i < functions; ++i) {
            const std::size_t id = words_.count("a control point");
            if (id >= spline_.control_points.size())
                words_.fail("control point " + std::to_string(id) + " of " +
                            std::to_string(spline_.control_points.size()) + " (0-based)");
            // Numbered from 1, so that 0 is none.
            std::size_t& last_element = last_element_of_.at(id);
            if (last_element == spline_.elements.size() + 1)
                words_.fail("control point " + std::to_string(id) + " twice in an element");
            last_element = spline_.elements.size() + 1;
            functions_.push_back(static_cast<std::uint32_t>(id));
        }
        for (auto& column : columns_) column.clear();
        for (const std::uint32_t function : functions_) read_row(function);

        std::array<std::uint32_t, 64> points;
        for (std::size_t p = 0; p < 64; ++p) {
            auto& column = columns_[p];
            if (column.empty())
                words_.fail("element " + std::to_string(spline_.elements.size()) +
                            " has no coefficient for Bezier point " + std::to_string(p));
            std::sort(column.begin(), column.end());
            for (const auto& [function, value] : column) {
                spline_.rows.columns.push_back(function);
                spline_.rows.values.push_back(value);
            }
            points[p] = static_cast<std::uint32_t>(spline_.rows.size());
            spline_.rows.offsets.push_back(spline_.rows.columns.size());
        }
        spline_.elements.push_back(points);
        if (spline_.elements.size() > elements_) words_.fail("more elements than elemN says");
    }

    void read_row(std::uint32_t function) {
        const std::string_view kind = words_.next("s or d");
        if (kind == "d") {
            for (auto& column : columns_) {
                const double value = words_.real("a coefficient");
                if (value != 0.0) column.emplace_back(function, value);
            }
            return;
        }
        if (kind != "s") words_.fail(quoted(kind) + " where a row, 's' or 'd', should be");
        const std::size_t count = words_.count("the number of coefficients");
        if (count > 64)
            words_.fail("a row of " + std::to_string(count) + " coefficients; there are 64 Bezier points");
        std::bitset<64> given;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t column = words_.count("a column");
            if (column >= 64) words_.fail("column " + std::to_string(column) + " of 64 (0-based)");
            if (given.test(column)) words_.fail("column " + std::to_string(column) + " twice in a row");
            given.set(column);
            const double value = words_.real("a coefficient");
            if (value != 0.0) columns_[column].emplace_back(function, value);
        }
    }

    Words words_;
    BezierSpline spline_;
    std::size_t nodes_ = 0, elements_ = 0;
    std::vector<std::uint32_t> functions_;
    std::vector<std::size_t> last_element_of_;  // of each control point, from 1; 0: of none yet
    std::array<std::vector<std::pair<std::uint32_t, double>>, 64> columns_;
};

}  // namespace

BezierSpline read_bext(const std::filesystem::path& path) {
    const std::string text = hex::io::read_text_file(path);
    try {
        if (text.starts_with("B E X T 2")) return to_spline(read_bext2(path));
    } catch (const hex::Error& error) {
        throw error.located(path.string());
    }
    return Reader(path, text).read();
}

}  // namespace spline::io
