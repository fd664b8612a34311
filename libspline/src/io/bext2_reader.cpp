#include "text_input.h"

#include <hex/base/error.h>
#include <hex/io/text_file.h>
#include <spline/io/bext2.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace spline::io {
namespace {

using hex::Error;
using hex::ErrorKind;

class Reader {
  public:
    Reader(const std::filesystem::path& path, std::string_view text) : words_(path, text, true) {}

    Bext2 read() {
        for (const char* letter : {"B", "E", "X", "T"}) {
            if (words_.next("B E X T 2.0") != letter)
                words_.fail("is not a BEXT file: it does not start with 'B E X T'");
        }
        const std::string_view version = words_.next("the version");
        if (version != "2.0" && version != "2")
            words_.fail("is BEXT " + std::string(version), ErrorKind::unsupported, "1 and 2.0 can be read");
        read_head();
        for (std::size_t b = 0; b < blocks_; ++b) read_block();
        if (data_.element_count() != elements_)
            words_.fail("the head says " + std::to_string(elements_) + " elements, there are " +
                        std::to_string(data_.element_count()));
        read_vectors();
        check_lengths();
        if (!words_.at_end()) words_.fail(quoted(words_.next("the end")) + " after the last vector");
        return std::move(data_);
    }

  private:
    void read_head() {
        data_.patch = words_.integer("the patch id");
        const std::size_t nodes = words_.count("the number of control points");
        elements_ = words_.count("the number of elements");
        if (elements_ == 0) words_.fail("has no elements");
        vectors_ = words_.count("the number of coefficient vectors");
        data_.weight_flag = words_.integer("the weight flag");
        data_.points.reserve(words_.at_most_left(nodes) / 4);
        for (std::size_t i = 0; i < nodes; ++i) {
            const auto [point, weight] = words_.weighted_point();
            data_.points.push_back(point);
            data_.weights.push_back(weight);
        }
        blocks_ = words_.count("the number of element blocks");
    }

    void read_block() {
        Bext2::Block block;
        block.type = static_cast<int>(words_.integer("the element type"));
        block.elements = words_.count("the number of elements");
        block.functions = words_.count("the number of control points of an element");
        // Nothing would be left to read for each of so many elements.
        if (block.functions == 0) words_.fail("elements without control points");
        const std::size_t vectors = words_.count("the number of coefficient vectors of an element");
        if (vectors != block.functions)
            words_.fail(std::to_string(vectors) + " coefficient vectors for " +
                            std::to_string(block.functions) + " control points",
                        ErrorKind::unsupported);
        for (int a = 0; a < 3 && !words_.at_end_of_line(); ++a) {
            const std::size_t degree = words_.count("a degree");
            if (degree > 20) words_.fail("degree " + std::to_string(degree), ErrorKind::unsupported);
            block.degrees.push_back(static_cast<int>(degree));
        }
        if (block.degrees.size() < 2) words_.fail("an element block has two or three degrees");
        const std::size_t total = words_.at_most_left(block.elements * block.functions);
        block.nodes.reserve(total);
        block.vectors.reserve(total);
        for (std::size_t e = 0; e < block.elements; ++e) {
            for (std::size_t i = 0; i < block.functions; ++i)
                block.nodes.push_back(words_.id("control point", data_.points.size()));
            for (std::size_t i = 0; i < block.functions; ++i)
                block.vectors.push_back(words_.id("coefficient vector", vectors_));
        }
        data_.blocks.push_back(std::move(block));
    }

    void read_vectors() {
        const std::size_t dense = words_.count("the number of dense groups");
        if (words_.count("the number of sparse groups") != 0)
            words_.fail("sparse coefficient vectors", ErrorKind::unsupported,
                        "write the file with dense ones");
        std::vector<std::size_t> counts;
        for (std::size_t g = 0; g < dense; ++g) {
            counts.push_back(words_.count("the number of vectors of a group"));
            Bext2::Group group;
            group.length = words_.count("the length of the vectors of a group");
            if (group.length == 0) words_.fail("coefficient vectors without components");
            data_.groups.push_back(std::move(group));
        }
        for (std::size_t g = 0; g < dense; ++g) {
            Bext2::Group& group = data_.groups[g];
            const std::size_t total = counts[g] * group.length;
            group.values.reserve(words_.at_most_left(total));
            for (std::size_t i = 0; i < total; ++i) group.values.push_back(words_.real("a coefficient"));
        }
        if (data_.vector_count() != vectors_)
            words_.fail("the head says " + std::to_string(vectors_) + " coefficient vectors, there are " +
                        std::to_string(data_.vector_count()));
    }

    void check_lengths() {
        std::vector<std::size_t> length;
        for (const Bext2::Group& group : data_.groups)
            length.insert(length.end(), group.count(), group.length);
        for (std::size_t b = 0; b < data_.blocks.size(); ++b) {
            std::size_t wanted = 1;
            for (const int degree : data_.blocks[b].degrees) wanted *= static_cast<std::size_t>(degree) + 1;
            for (const std::uint32_t v : data_.blocks[b].vectors) {
                if (length[v] != wanted)
                    words_.fail("coefficient vector " + std::to_string(v + 1) + " has " +
                                std::to_string(length[v]) + " components, elements of block " +
                                std::to_string(b + 1) + " need " + std::to_string(wanted));
            }
        }
    }

    Words words_;
    Bext2 data_;
    std::size_t elements_ = 0, vectors_ = 0, blocks_ = 0;
};

/// From Bernstein coefficients of degree `degree` to those of degree 3, [cubic][lower].
std::vector<std::array<double, 4>> raise_to_cubic(int degree) {
    std::vector<std::array<double, 4>> result;
    for (int i = 0; i <= degree; ++i) {
        std::vector<double> c(static_cast<std::size_t>(degree) + 1, 0.0);
        c[static_cast<std::size_t>(i)] = 1.0;
        for (int n = degree; n < 3; ++n) {
            std::vector<double> next(c.size() + 1, 0.0);
            for (std::size_t k = 0; k < next.size(); ++k) {
                const auto share = static_cast<double>(k);
                if (k > 0) next[k] += share / (n + 1) * c[k - 1];
                if (k < c.size()) next[k] += (n + 1 - share) / (n + 1) * c[k];
            }
            c = std::move(next);
        }
        result.push_back({c[0], c[1], c[2], c[3]});
    }
    return result;
}

/// One coefficient vector as 64 cubic coefficients.
std::array<double, 64> as_tricubic(const double* values, const std::vector<int>& degrees) {
    std::array<std::vector<std::array<double, 4>>, 3> raise;
    for (std::size_t a = 0; a < 3; ++a) raise[a] = raise_to_cubic(degrees[a]);
    std::array<double, 64> result{};
    std::size_t next = 0;
    for (const auto& w : raise[2])
        for (const auto& v : raise[1])
            for (const auto& u : raise[0]) {
                const double value = values[next++];
                if (value == 0.0) continue;
                for (std::size_t p = 0; p < 64; ++p) result[p] += value * u[p % 4] * v[p / 4 % 4] * w[p / 16];
            }
    return result;
}

}  // namespace

std::size_t Bext2::element_count() const {
    std::size_t count = 0;
    for (const Block& block : blocks) count += block.elements;
    return count;
}

std::size_t Bext2::vector_count() const {
    std::size_t count = 0;
    for (const Group& group : groups) count += group.count();
    return count;
}

Bext2 read_bext2(const std::filesystem::path& path) {
    const std::string text = hex::io::read_text_file(path);
    return Reader(path, text).read();
}

BezierSpline to_spline(const Bext2& data) {
    BezierSpline spline;
    spline.control_points = data.points;
    spline.weights = data.weights;
    std::vector<const double*> vectors;
    for (const Bext2::Group& group : data.groups)
        for (std::size_t v = 0; v < group.count(); ++v)
            vectors.push_back(group.values.data() + v * group.length);
    for (const Bext2::Block& block : data.blocks) {
        if (block.degrees.size() != 3)
            throw Error(ErrorKind::unsupported, "surface elements cannot be used as a solid spline");
        for (const int degree : block.degrees) {
            if (degree < 1 || degree > 3)
                throw Error(ErrorKind::unsupported,
                            "elements of degree " + std::to_string(degree) + " cannot be used; 1 to 3 can");
        }
        std::vector<std::uint32_t> place(vectors.size(), 0);
        std::vector<std::array<double, 64>> raised;
        for (std::size_t e = 0; e < block.elements; ++e) {
            std::vector<std::pair<std::uint32_t, std::uint32_t>> functions;
            for (std::size_t i = e * block.functions; i < (e + 1) * block.functions; ++i) {
                const std::uint32_t v = block.vectors[i];
                if (place[v] == 0) {
                    raised.push_back(as_tricubic(vectors[v], block.degrees));
                    place[v] = static_cast<std::uint32_t>(raised.size());
                }
                functions.emplace_back(block.nodes[i], place[v] - 1);
            }
            std::sort(functions.begin(), functions.end());
            for (std::size_t i = 1; i < functions.size(); ++i) {
                if (functions[i].first == functions[i - 1].first)
                    throw Error(ErrorKind::bad_input,
                                "control point " + std::to_string(functions[i].first + 1) +
                                    " twice in element " + std::to_string(spline.elements.size() + 1));
            }
            std::array<std::uint32_t, 64> points;
            for (std::size_t p = 0; p < 64; ++p) {
                const std::size_t before = spline.rows.columns.size();
                for (const auto& [node, v] : functions) {
                    if (raised[v][p] == 0.0) continue;
                    spline.rows.columns.push_back(node);
                    spline.rows.values.push_back(raised[v][p]);
                }
                if (spline.rows.columns.size() == before)
                    throw Error(ErrorKind::bad_input, "element " +
                                                          std::to_string(spline.elements.size() + 1) +
                                                          " has no coefficient for a Bezier point");
                points[p] = static_cast<std::uint32_t>(spline.rows.size());
                spline.rows.offsets.push_back(spline.rows.columns.size());
            }
            spline.element_cell.push_back(static_cast<std::uint32_t>(spline.elements.size()));
            spline.elements.push_back(points);
        }
    }
    spline.element_level.assign(spline.elements.size(), 0);
    return spline;
}

}  // namespace spline::io
