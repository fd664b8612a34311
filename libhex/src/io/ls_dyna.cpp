// LS-DYNA keyword files (.k): nodes, shells and solids, in the layouts of LS-PrePost and of the paper's
// programs.
#include "io/formats.h"
#include "io/id_map.h"
#include "io/part_numbers.h"

#include <hex/base/error.h>
#include <hex/io/number_text.h>

#include <algorithm>
#include <array>
#include <climits>
#include <map>
#include <set>
#include <span>

namespace hex::io {
namespace {

constexpr std::size_t most_fields = 12;

/// The fields of one card. Empty text: blank field.
struct Card {
    std::array<std::string_view, most_fields> fields;
    std::size_t count = 0;

    bool add(std::string_view field) {
        if (count == most_fields) return false;
        fields[count++] = field;
        return true;
    }
    /// Fields up to the last one that is not blank.
    void drop_trailing_blanks() {
        while (count > 0 && fields[count - 1].empty()) --count;
    }
};

Card split_commas(std::string_view line) {
    Card card;
    while (true) {
        const std::size_t comma = line.find(',');
        if (!card.add(trimmed(line.substr(0, comma))) || comma == std::string_view::npos) break;
        line.remove_prefix(comma + 1);
    }
    card.drop_trailing_blanks();
    return card;
}

Card split_blanks(std::string_view line) {
    Card card;
    line = trimmed(line);
    while (!line.empty()) {
        const auto end = std::find_if(line.begin(), line.end(), is_blank);
        const auto length = static_cast<std::size_t>(end - line.begin());
        if (!card.add(line.substr(0, length))) break;
        line = trimmed(line.substr(length));
    }
    return card;
}

bool is_solid_text(std::string_view text) {
    return std::none_of(text.begin(), text.end(), is_blank);
}

/// Columns of the given widths; not valid when a column border cuts through a word, or a column holds two
/// words. Two full columns may touch: then at least one of the two is filled to its borders.
bool split_columns(std::string_view line, std::span<const std::size_t> widths, Card& card) {
    card = {};
    std::size_t start = 0;
    std::string_view before;
    for (const std::size_t width : widths) {
        if (start >= line.size()) break;
        const std::string_view column = line.substr(start, width);
        const std::string_view field = trimmed(column);
        if (!is_solid_text(field)) return false;
        const bool touches = !before.empty() && !is_blank(before.back()) && !is_blank(column.front());
        if (touches && !is_solid_text(before) && !(column.size() == width && is_solid_text(column)))
            return false;
        card.add(field);
        before = column;
        start += width;
    }
    card.drop_trailing_blanks();
    return true;
}

constexpr std::array<std::size_t, 10> element_columns = {8, 8, 8, 8, 8, 8, 8, 8, 8, 8};
constexpr std::array<std::size_t, 6> node_columns = {8, 16, 16, 16, 8, 8};

/// The layout is told line by line: a comma, else columns when they make sense, else blanks.
template <class Accept>
Card split_card(std::string_view line, std::span<const std::size_t> columns, const Accept& accept) {
    if (line.find(',') != std::string_view::npos) return split_commas(line);
    Card card;
    if (split_columns(line, columns, card) && accept(card)) return card;
    return split_blanks(line);
}

/// An element as the file has it: node ids, and the line for messages.
template <std::size_t Corners>
struct Element {
    std::array<long long, Corners> nodes;
    int part;
    std::uint32_t line;
};

class LsDynaReader {
  public:
    explicit LsDynaReader(const InputFile& file) : file_(file) {}

    MeshData read() {
        std::string_view rest = file_.bytes().substr(file_.text_start());
        bool ended = false;
        while (!rest.empty() && !ended) {
            const std::size_t end = rest.find('\n');
            std::string_view line = rest.substr(0, end);
            rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
            ++line_;
            while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
            // The title of a part may be blank.
            if ((line.empty() && !part_title_next_) || line.starts_with('$')) continue;
            if (line.starts_with('*')) {
                ended = keyword(line);
            } else {
                card(line);
            }
        }
        if (!seen_keyword_) fail("no LS-DYNA keyword (a line that starts with *) found");
        if (pending_solid_)
            fail("the file ends before the nodes of solid element " + std::to_string(pending_id_));
        if (!ended) data_.warn("no-end", "the file has no *END line: it may have been cut off");
        finish();
        return std::move(data_);
    }

  private:
    enum class Block { none, node, shell, solid, part, skipped };

    [[noreturn]] void fail(const std::string& what, std::uint32_t line = 0,
                           ErrorKind kind = ErrorKind::bad_input) const {
        throw Error(kind, what, file_.name() + ":" + std::to_string(line == 0 ? line_ : line));
    }

    /// Returns true at *END.
    bool keyword(std::string_view line) {
        if (pending_solid_)
            fail("the nodes of solid element " + std::to_string(pending_id_) + " are missing");
        const std::string word = upper_case(line.substr(0, line.find_first_of(" \t,(")));
        seen_keyword_ = true;
        part_title_next_ = word == "*PART";
        if (word == "*END") return true;
        if (word == "*NODE") {
            block_ = Block::node;
        } else if (word == "*ELEMENT_SHELL") {
            block_ = Block::shell;
        } else if (word == "*ELEMENT_SOLID") {
            block_ = Block::solid;
        } else if (word == "*PART") {
            block_ = Block::part;
        } else if (word == "*KEYWORD") {
            block_ = Block::none;
        } else {
            block_ = Block::skipped;
            // A title says nothing about the mesh.
            if (word != "*TITLE") skipped_[word].push_back(line_);
        }
        return false;
    }

    void card(std::string_view line) {
        switch (block_) {
            case Block::none:
                fail("data outside of any keyword: " + in_quotes(line));
            case Block::skipped:
                return;
            case Block::node:
                return node(line);
            case Block::shell:
                return shell(line);
            case Block::solid:
                return solid(line);
            case Block::part:
                return part_name(line);
        }
    }

    /// By turns the title of a part and a card that starts with its id, in ten columns.
    void part_name(std::string_view line) {
        part_title_next_ = !part_title_next_;
        if (!part_title_next_) {
            title_ = trimmed(line);
            return;
        }
        const std::size_t comma = line.find(',');
        auto id = parse_integer(trimmed(line.substr(0, comma == std::string_view::npos ? 10 : comma)));
        if (!id) id = parse_integer(split_blanks(line).fields[0]);
        if (id && *id >= INT_MIN && *id <= INT_MAX && !title_.empty())
            titles_.emplace(static_cast<int>(*id), title_);
    }

    void node(std::string_view line) {
        const Card card = split_card(line, node_columns, [](const Card& c) {
            return c.count >= 4 && parse_integer(c.fields[0]) && parse_double(c.fields[1]) &&
                   parse_double(c.fields[2]) && parse_double(c.fields[3]);
        });
        if (card.count < 4) fail("a node needs an id and three coordinates, not " + in_quotes(line));
        node_ids_.add(id(card.fields[0], "node id"));
        node_lines_.push_back(line_);
        Vec3 point;
        for (int k = 0; k < 3; ++k) {
            const std::string_view field = card.fields[static_cast<std::size_t>(k + 1)];
            const auto value = parse_double(field);
            if (!value) fail("a coordinate should be a finite number, not " + in_quotes(field));
            point[k] = *value;
        }
        data_.points().push_back(point);
    }

    long long id(std::string_view field, const char* what) const {
        const auto value = parse_integer(field);
        if (!value) fail(std::string(what) + " should be an integer, not " + in_quotes(field));
        if (*value < 1) fail(std::string(what) + " " + std::to_string(*value) + " is not positive");
        return *value;
    }

    int part(std::string_view field) const {
        const auto value = parse_integer(field);
        if (!value || *value < INT_MIN || *value > INT_MAX)
            fail("part id should be an integer, not " + in_quotes(field));
        return static_cast<int>(*value);
    }

    static bool starts_with_integers(const Card& card, std::size_t needed) {
        if (card.count < needed) return false;
        for (std::size_t i = 0; i < needed; ++i) {
            if (!parse_integer(card.fields[i])) return false;
        }
        return true;
    }

    /// Blank and 0 both mean "no node".
    static bool no_node(const Card& card, std::size_t i) {
        return i >= card.count || card.fields[i].empty() || parse_integer(card.fields[i]) == 0;
    }

    void shell(std::string_view line) {
        const Card card =
            split_card(line, element_columns, [](const Card& c) { return starts_with_integers(c, 5); });
        if (card.count < 5)
            fail("a shell needs an id, a part id and three or four nodes, not " + in_quotes(line));
        shell_ids_.add(id(card.fields[0], "shell id"));
        Element<4> element{{}, part(card.fields[1]), line_};
        for (std::size_t i = 0; i < 3; ++i) element.nodes[i] = id(card.fields[2 + i], "node id");
        element.nodes[3] = no_node(card, 5) ? element.nodes[2] : id(card.fields[5], "node id");
        for (std::size_t i = 6; i < 10; ++i) {
            if (!no_node(card, i))
                fail("shells with nodes on their edges are not supported", 0, ErrorKind::unsupported);
        }
        shells_.push_back(element);
    }

    void solid(std::string_view line) {
        const Card card = split_card(line, element_columns, [&](const Card& c) {
            return starts_with_integers(c, pending_solid_ ? 8 : c.count == 2 ? 2 : 10);
        });
        std::size_t first = 0;
        if (!pending_solid_) {
            if (card.count < 2)
                fail("a solid needs an id, a part id and eight nodes, not " + in_quotes(line));
            pending_id_ = id(card.fields[0], "solid id");
            solid_ids_.add(pending_id_);
            pending_part_ = part(card.fields[1]);
            first = 2;
            // The newer layout of LS-DYNA: the nodes follow on a line of their own.
            if (card.count == 2) {
                pending_solid_ = true;
                return;
            }
        }
        pending_solid_ = false;
        if (card.count < first + 8)
            fail("solid element " + std::to_string(pending_id_) + " needs eight nodes and has " +
                 std::to_string(card.count - first));
        Element<8> element{{}, pending_part_, line_};
        for (std::size_t i = 0; i < 8; ++i) element.nodes[i] = id(card.fields[first + i], "node id");
        for (std::size_t i = first + 8; i < card.count; ++i) {
            if (!no_node(card, i))
                fail("solids with more than eight nodes are not supported", 0, ErrorKind::unsupported);
        }
        solids_.push_back(element);
    }

    std::uint32_t vertex(long long node, long long element, std::uint32_t line) const {
        const std::size_t v = node_ids_.find(node);
        if (v == node_ids_.size())
            fail("element " + std::to_string(element) + " uses node " + std::to_string(node) +
                     ", which the file does not define",
                 line);
        return static_cast<std::uint32_t>(v);
    }

    void finish() {
        const auto check_ids = [&](IdMap& ids, const char* what, const auto& line_of) {
            const std::size_t twice = ids.finish();
            if (twice < ids.size())
                fail(std::string(what) + " " + std::to_string(ids.id(twice)) + " is defined twice",
                     line_of(twice));
        };
        check_ids(node_ids_, "node", [&](std::size_t i) { return node_lines_[i]; });
        check_ids(shell_ids_, "shell element", [&](std::size_t i) { return shells_[i].line; });
        check_ids(solid_ids_, "solid element", [&](std::size_t i) { return solids_[i].line; });

        for (std::size_t e = 0; e < shells_.size(); ++e) {
            const auto& shell = shells_[e];
            std::array<std::uint32_t, 4> corners{};
            for (std::size_t i = 0; i < 4; ++i)
                corners[i] = vertex(shell.nodes[i], shell_ids_.id(e), shell.line);
            const std::size_t count = corners[3] == corners[2] ? 3 : 4;
            data_.add_polygon(std::span(corners).first(count), shell.part);
        }
        data_.hexahedra.reserve(solids_.size());
        data_.hexahedron_parts.reserve(solids_.size());
        for (std::size_t e = 0; e < solids_.size(); ++e) {
            const auto& solid = solids_[e];
            HexCell cell;
            for (std::size_t i = 0; i < 8; ++i) {
                cell[i] = VertexId(vertex(solid.nodes[i], solid_ids_.id(e), solid.line));
                if (std::find(cell.begin(), cell.begin() + i, cell[i]) != cell.begin() + i)
                    fail("solid element " + std::to_string(solid_ids_.id(e)) + " uses node " +
                             std::to_string(solid.nodes[i]) + " twice: it is no hexahedron",
                         solid.line);
            }
            data_.hexahedra.push_back(cell);
            data_.hexahedron_parts.push_back(solid.part);
        }
        // Titles of parts that have elements here, and are no names of ours.
        std::set<int> parts(data_.surface.parts.begin(), data_.surface.parts.end());
        parts.insert(data_.hexahedron_parts.begin(), data_.hexahedron_parts.end());
        for (const auto& [id, title] : titles_)
            if (parts.contains(id) && title != name_of_part(id, {})) data_.part_names.emplace(id, title);
        for (const auto& [word, lines] : skipped_)
            data_.warn("unknown-keyword",
                       "keyword " + in_quotes(word) + " in line " + list_ids(lines) +
                           " is not known; its data is skipped",
                       "line", lines);
    }

    const InputFile& file_;
    MeshData data_;
    Block block_ = Block::none;
    std::uint32_t line_ = 0;
    bool seen_keyword_ = false;
    bool pending_solid_ = false;
    long long pending_id_ = 0;
    int pending_part_ = 1;
    bool part_title_next_ = false;
    std::string title_;
    PartNames titles_;
    IdMap node_ids_, shell_ids_, solid_ids_;
    std::vector<std::uint32_t> node_lines_;
    std::vector<Element<4>> shells_;
    std::vector<Element<8>> solids_;
    std::map<std::string, std::vector<std::int64_t>> skipped_;
};

/// Titles of the parts that have a name.
void append_header(OutputFile& out, const char* block, std::vector<int> parts, const PartNames& names) {
    out.write("$# LS-DYNA keyword file written by hexspline\n*KEYWORD\n");
    for (const auto& [part, name] : ls_dyna_names(distinct_parts(std::move(parts)), names)) {
        if (!names.contains(part)) continue;
        out.write("*PART\n" + name + "\n");
        append_number(out.buffer(), part);
        out.write(",0,0\n");
    }
    out.write(block);
}

template <class Corners>
void append_element(std::string& text, std::size_t id, int part, const Corners& corners) {
    append_number(text, id);
    text += ',';
    append_number(text, part);
    for (const std::size_t v : corners) {
        text += ',';
        append_number(text, v + 1);
    }
    text += '\n';
}

/// Comma separated, because 16 columns do not hold the 17 digits a double may need.
void append_nodes(OutputFile& out, std::span<const Vec3> points) {
    out.write("*NODE\n");
    std::string& text = out.buffer();
    for (std::size_t v = 0; v < points.size(); ++v) {
        append_number(text, v + 1);
        text += ',';
        append_point(text, points[v], ',');
        text += '\n';
        out.flush_if_large();
    }
    out.write("*END\n");
}

}  // namespace

MeshData read_ls_dyna(const InputFile& file) {
    return LsDynaReader(file).read();
}

PartNames ls_dyna_names(std::span<const int> parts, const PartNames& names) {
    // A title is a line of 80 columns that is neither a comment nor a keyword.
    return names_within({"", "$*", 80}, parts, names);
}

void write_ls_dyna_surface(OutputFile& out, const PolygonSoup& soup, const PartNames& names) {
    append_header(out, "*ELEMENT_SHELL\n", soup.parts, names);
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto polygon = soup.polygon(f);
        const std::array<std::size_t, 4> corners = {polygon[0], polygon[1], polygon[2], polygon.back()};
        append_element(out.buffer(), f + 1, soup.parts[f], corners);
        out.flush_if_large();
    }
    append_nodes(out, soup.points);
}

void write_ls_dyna_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields) {
    const auto& parts = mesh.parts();
    append_header(out, "*ELEMENT_SOLID\n", {parts.begin(), parts.end()}, fields.part_names);
    for (const CellId c : mesh.cells()) {
        std::array<std::size_t, 8> corners{};
        for (std::size_t i = 0; i < 8; ++i) corners[i] = mesh.cell(c)[i].index();
        append_element(out.buffer(), c.index() + 1, mesh.part(c), corners);
        out.flush_if_large();
    }
    append_nodes(out, mesh.positions());
}

}  // namespace hex::io
