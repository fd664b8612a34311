// Abaqus input files (.inp): nodes, shells and eight-node solids; element sets are parts.
#include "io/element_sets.h"
#include "io/formats.h"
#include "io/id_map.h"
#include "io/part_numbers.h"

#include <hex/base/error.h>
#include <hex/io/number_text.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace hex::io {
namespace {

/// Corners of the element types that are read; 0 for lines, points and springs, which are skipped.
std::optional<std::size_t> corners_of(std::string_view type) {
    const auto starts = [&](std::initializer_list<std::string_view> names) {
        return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
            if (!type.starts_with(name)) return false;
            // What follows the number of nodes are letters: S4R, C3D8R, C3D8RH; C3D20 is no C3D2.
            return type.size() == name.size() || type[name.size()] < '0' || type[name.size()] > '9';
        });
    };
    if (starts({"C3D8", "DC3D8", "AC3D8", "DCC3D8", "Q3D8"})) return 8;
    if (starts({"S4", "DS4", "M3D4", "SFM3D4", "R3D4", "F3D4", "CPS4", "CPE4"})) return 4;
    if (starts({"S3", "STRI3", "DS3", "M3D3", "SFM3D3", "R3D3", "F3D3", "CPS3", "CPE3"})) return 3;
    if (starts({"B21", "B22", "B31", "B32", "B33", "T2D2", "T3D2", "MASS", "ROTARYI", "SPRINGA", "SPRING1",
                "SPRING2", "DASHPOTA", "CONN3D2", "R3D2", "RB3D2"}))
        return 0;
    return std::nullopt;
}

/// What generates a mesh, or moves it, cannot be passed over.
constexpr std::array<std::string_view, 10> unsupported_keywords = {
    "INCLUDE",           "NGEN",     "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM",
    "SUBSTRUCTURE PATH", "TRANSFORM"};

struct Keyword {
    std::string name;
    std::map<std::string, std::string> parameters;  // names in capitals
};

struct Element {
    std::array<long long, 8> nodes{};
    std::size_t corners = 0;
    std::size_t position = 0;  // in the file
};

class AbaqusReader {
  public:
    explicit AbaqusReader(const InputFile& file) : file_(file) {}

    MeshData read() {
        const std::string_view text = file_.bytes();
        std::size_t next = file_.text_start();
        while (next < text.size()) {
            position_ = next;
            const std::size_t end = std::min(text.find('\n', next), text.size());
            const std::string_view line = trimmed(text.substr(next, end - next));
            next = end + 1;
            if (line.empty() || line.starts_with("**")) continue;
            if (line.front() == '*')
                keyword(whole_keyword(line, next));
            else
                data(line);
        }
        if (!seen_keyword_) fail("not an Abaqus input file: no keyword (a line that starts with *) found");
        if (!pending_.empty()) fail("the file ends within element " + std::to_string(pending_.front()));
        finish();
        return std::move(data_);
    }

  private:
    enum class Block { none, node, element, skipped_element, element_set, skipped };

    [[noreturn]] void fail(const std::string& what, ErrorKind kind = ErrorKind::bad_input) const {
        throw Error(kind, what, file_.line_place(position_));
    }

    /// A keyword goes on in the next line after a comma.
    std::string whole_keyword(std::string_view line, std::size_t& next) const {
        std::string whole(line);
        const std::string_view text = file_.bytes();
        while (whole.ends_with(',') && next < text.size()) {
            const std::size_t end = std::min(text.find('\n', next), text.size());
            whole += trimmed(text.substr(next, end - next));
            next = end + 1;
        }
        return whole;
    }

    static std::vector<std::string_view> fields_of(std::string_view line) {
        std::vector<std::string_view> fields;
        while (true) {
            const std::size_t comma = line.find(',');
            fields.push_back(trimmed(line.substr(0, comma)));
            if (comma == std::string_view::npos) break;
            line.remove_prefix(comma + 1);
        }
        if (fields.back().empty()) fields.pop_back();
        return fields;
    }

    static Keyword parse_keyword(const std::string& line) {
        Keyword result;
        for (const std::string_view field : fields_of(std::string_view(line).substr(1))) {
            const std::size_t equals = field.find('=');
            const std::string name = upper_case(trimmed(field.substr(0, equals)));
            if (result.name.empty() && result.parameters.empty() && equals == std::string_view::npos) {
                result.name = name;
                continue;
            }
            std::string_view value =
                equals == std::string_view::npos ? std::string_view() : trimmed(field.substr(equals + 1));
            if (value.size() > 1 && value.front() == '"' && value.back() == '"')
                value = value.substr(1, value.size() - 2);
            result.parameters[name] = std::string(value);
        }
        return result;
    }

    void keyword(const std::string& line) {
        if (!pending_.empty()) fail("element " + std::to_string(pending_.front()) + " lacks nodes");
        seen_keyword_ = true;
        const Keyword word = parse_keyword(line);
        const auto value = [&](const char* name) {
            const auto found = word.parameters.find(name);
            return found == word.parameters.end() ? std::string() : found->second;
        };
        const auto& all = unsupported_keywords;
        if (std::find(all.begin(), all.end(), word.name) != all.end())
            fail("keyword *" + word.name + " is not supported", ErrorKind::unsupported);
        last_keyword_is_instance_ = word.name == "INSTANCE";
        if (word.name == "INSTANCE" || word.name == "END INSTANCE") in_instance_ = word.name == "INSTANCE";
        if (word.name == "ASSEMBLY" || word.name == "END ASSEMBLY") in_assembly_ = word.name == "ASSEMBLY";
        block_ = Block::skipped;
        if (word.name == "NODE") {
            if (word.parameters.contains("SYSTEM") && upper_case(value("SYSTEM")) != "R")
                fail("nodes in cylindrical or spherical coordinates are not supported",
                     ErrorKind::unsupported);
            if (word.parameters.contains("INPUT"))
                fail("*NODE, INPUT= is not supported", ErrorKind::unsupported);
            // Reference points: their numbers are the assembly's own.
            if (of_assembly()) skipped_keywords_[word.name].push_back(position_);
            block_ = of_assembly() ? Block::skipped : Block::node;
        } else if (word.name == "ELEMENT") {
            if (word.parameters.contains("INPUT"))
                fail("*ELEMENT, INPUT= is not supported", ErrorKind::unsupported);
            const std::string type = upper_case(value("TYPE"));
            const auto corners = corners_of(type);
            if (!corners)
                fail(
                    "elements of type " + in_quotes(type) +
                        " are not supported: only three- and four-node shells and eight-node solids are read",
                    ErrorKind::unsupported);
            corners_ = *corners;
            if (of_assembly() && corners_ > 0)
                fail("elements of the assembly are not supported", ErrorKind::unsupported);
            set_ = value("ELSET").empty() ? -1 : set_named(value("ELSET"));
            block_ = corners_ > 0 ? Block::element : Block::skipped_element;
            if (corners_ == 0) ++skipped_blocks_;
            continued_ = false;
        } else if (word.name == "ELSET") {
            if (value("ELSET").empty()) fail("*ELSET needs ELSET=name");
            block_ = Block::element_set;
            set_ = set_named(value("ELSET"));
            generate_ = is_generated(word);
        } else if (word.name == "NSET" || word.name == "SURFACE") {
            skipped_keywords_[word.name].push_back(position_);
        } else if (word.name == "PART") {
            if (++parts_ > 1)
                fail("a second *PART: assemblies of several parts are not supported", ErrorKind::unsupported);
        } else if (last_keyword_is_instance_ && ++instances_ > 1) {
            fail("a second *INSTANCE: assemblies of several instances are not supported",
                 ErrorKind::unsupported);
        }
    }

    /// The assembly has names of its own: one that its part has, too, is another set.
    int set_named(const std::string& name) {
        if (!of_assembly()) {
            part_sets_.insert(upper_case(name));
            return sets_.index_of(name);
        }
        return sets_.index_of(part_sets_.contains(upper_case(name)) ? "Assembly." + name : name);
    }

    /// Whether what is read now is the assembly's own, not of a part or an instance of one.
    bool of_assembly() const { return in_assembly_ && !in_instance_; }

    /// Parameters of *ELSET may be cut short. An unknown one might give the lines below another meaning.
    bool is_generated(const Keyword& set) const {
        static constexpr std::array<std::string_view, 5> known = {"ELSET", "GENERATE", "INSTANCE", "INTERNAL",
                                                                  "UNSORTED"};
        bool generated = false;
        for (const auto& parameter : set.parameters) {
            const std::string& name = parameter.first;
            const auto is_meant = [&](std::string_view whole) { return whole.starts_with(name); };
            if (name.empty() || std::none_of(known.begin(), known.end(), is_meant))
                fail("*ELSET has no parameter " + in_quotes(name), ErrorKind::unsupported);
            generated |= known[1].starts_with(name);
        }
        return generated;
    }

    void data(std::string_view line) {
        if (!seen_keyword_) fail("not an Abaqus input file: it starts with " + in_quotes(line));
        if (last_keyword_is_instance_)
            fail("an instance that is moved is not supported", ErrorKind::unsupported);
        switch (block_) {
            case Block::node:
                return node(fields_of(line));
            case Block::element:
                return element(fields_of(line));
            case Block::skipped_element:
                return skipped_element(line);
            case Block::element_set:
                return element_set(fields_of(line));
            default:
                return;
        }
    }

    long long id(std::string_view field, const char* what) const {
        const auto value = parse_integer(field);
        if (!value) fail(std::string(what) + " should be an integer, not " + in_quotes(field));
        if (*value < 1) fail(std::string(what) + " " + std::to_string(*value) + " is not positive");
        return *value;
    }

    void node(const std::vector<std::string_view>& fields) {
        if (fields.size() < 2) fail("a node needs an id and coordinates");
        node_ids_.add(id(fields[0], "node id"));
        node_positions_.push_back(position_);
        Vec3 point = Vec3::Zero();
        for (std::size_t k = 0; k < 3 && k + 1 < fields.size(); ++k) {
            const std::string_view field = fields[k + 1];
            const auto value = field.empty() ? std::optional<double>(0.0) : parse_double(field);
            if (!value) fail("a coordinate should be a finite number, not " + in_quotes(field));
            point[static_cast<Eigen::Index>(k)] = *value;
        }
        data_.points().push_back(point);
    }

    void element(const std::vector<std::string_view>& fields) {
        for (const std::string_view field : fields)
            pending_.push_back(id(field, pending_.empty() ? "element id" : "node id"));
        if (pending_.size() < corners_ + 1) return;  // the rest is in the next line
        if (pending_.size() > corners_ + 1)
            fail("element " + std::to_string(pending_.front()) + " has " +
                 std::to_string(pending_.size() - 1) + " nodes, and its type has " +
                 std::to_string(corners_));
        Element result;
        result.corners = corners_;
        result.position = position_;
        std::copy(pending_.begin() + 1, pending_.end(), result.nodes.begin());
        element_ids_.add(pending_.front());
        if (set_ >= 0) sets_.add(set_, pending_.front(), pending_.front(), 1);
        elements_.push_back(result);
        pending_.clear();
    }

    /// Sets may hold elements that are not kept.
    void skipped_element(std::string_view line) {
        const auto value = parse_integer(trimmed(line.substr(0, line.find(','))));
        if (!continued_ && value && *value >= 1) skipped_ids_.push_back(*value);
        continued_ = line.ends_with(',');
    }

    void element_set(const std::vector<std::string_view>& fields) {
        if (generate_) {
            if (fields.size() < 2 || fields.size() > 3) fail("*ELSET, GENERATE needs first, last, step");
            const long long first = id(fields[0], "element id"), last = id(fields[1], "element id");
            const long long step = fields.size() > 2 ? id(fields[2], "the step") : 1;
            if (last < first) fail("the last element is smaller than the first");
            sets_.add(set_, first, last, step);
            return;
        }
        for (const std::string_view field : fields) {
            const auto value = parse_integer(field);
            if (!value)
                nested_sets_ = true;
            else
                sets_.add(set_, id(field, "element id"), *value, 1);
        }
    }

    void check_ids(IdMap& ids, const char* what, const auto& position_of) {
        const std::size_t twice = ids.finish();
        if (twice == ids.size()) return;
        position_ = position_of(twice);
        fail(std::string(what) + " " + std::to_string(ids.id(twice)) + " is defined twice");
    }

    void finish() {
        check_ids(node_ids_, "node", [&](std::size_t i) { return node_positions_[i]; });
        check_ids(element_ids_, "element", [&](std::size_t i) { return elements_[i].position; });
        const std::vector<int> set_of_element = assign_sets();
        std::vector<std::string> used_names;
        std::vector<int> number_of_set(sets_.size(), -1);
        for (const int set : set_of_element) {
            if (set < 0 || number_of_set[static_cast<std::size_t>(set)] >= 0) continue;
            number_of_set[static_cast<std::size_t>(set)] = static_cast<int>(used_names.size());
            used_names.push_back(sets_.name(set));
        }
        const std::vector<int> numbers = number_parts(used_names, data_.part_names);
        const int rest = number_of_rest(numbers);
        for (std::size_t e = 0; e < elements_.size(); ++e) {
            const int set = set_of_element[e];
            const int part =
                set < 0 ? rest
                        : numbers[static_cast<std::size_t>(number_of_set[static_cast<std::size_t>(set)])];
            add(elements_[e], e, part);
        }
        if (skipped_blocks_ > 0)
            data_.warn("elements-skipped",
                       std::to_string(skipped_blocks_) + " blocks of points, lines and springs are skipped");
        if (nested_sets_) data_.warn("sets-skipped", "sets inside of element sets are skipped");
        for (const auto& [name, positions] : skipped_keywords_) {
            const std::vector<std::int64_t> lines = lines_of(positions);
            const std::string what = name == "NSET"   ? "node sets"
                                     : name == "NODE" ? "reference points of the assembly"
                                                      : "surfaces made of element faces";
            data_.warn(name == "NODE" ? "nodes-skipped" : "sets-skipped",
                       what + " (*" + name + " in line " + list_ids(lines) + ") are skipped", "line", lines);
        }
    }

    /// The lines of positions that ascend.
    std::vector<std::int64_t> lines_of(const std::vector<std::size_t>& positions) const {
        std::vector<std::int64_t> lines;
        std::int64_t line = 1;
        auto next = file_.bytes().begin();
        for (const std::size_t position : positions) {
            const auto end = file_.bytes().begin() + static_cast<std::ptrdiff_t>(position);
            line += std::count(next, end, '\n');
            next = end;
            lines.push_back(line);
        }
        return lines;
    }

    /// The part of elements in no set: 1 when there are no sets at all.
    static int number_of_rest(const std::vector<int>& numbers) {
        const std::set<int> taken(numbers.begin(), numbers.end());
        int rest = 1;
        while (taken.contains(rest)) ++rest;
        return rest;
    }

    /// An element belongs to the first set that has it; a set of all elements is for the rest.
    std::vector<int> assign_sets() {
        std::vector<long long> ids;
        ids.reserve(elements_.size());
        for (std::size_t e = 0; e < elements_.size(); ++e) ids.push_back(element_ids_.id(e));
        ElementSets::Assignment assignment = sets_.assign(ids, skipped_ids_);
        if (assignment.overlap)
            data_.warn("sets-overlap", "element sets overlap: an element belongs to the first that has it");
        const auto more = [](const std::vector<int>& sets) {
            return sets.size() > 1 ? " (and " + std::to_string(sets.size() - 1) + " more such sets)"
                                   : std::string();
        };
        if (const auto& unused = assignment.without_elements; !unused.empty())
            data_.warn("sets-skipped", "element set " + in_quotes(sets_.name(unused.front())) +
                                           " of all elements is not kept: each of them is in another set" +
                                           more(unused));
        if (const auto& sets = assignment.incomplete; !sets.empty())
            data_.warn("elements-missing", "element set " + in_quotes(sets_.name(sets.front())) +
                                               " names element " + std::to_string(assignment.missing_id) +
                                               ", which the file does not define" + more(sets));
        return std::move(assignment.set_of_element);
    }

    void add(const Element& element, std::size_t e, int part) {
        position_ = element.position;
        std::array<std::uint32_t, 8> corners{};
        for (std::size_t i = 0; i < element.corners; ++i) {
            const std::size_t v = node_ids_.find(element.nodes[i]);
            if (v == node_ids_.size())
                fail("element " + std::to_string(element_ids_.id(e)) + " uses node " +
                     std::to_string(element.nodes[i]) + ", which the file does not define");
            corners[i] = static_cast<std::uint32_t>(v);
        }
        if (element.corners < 8) {
            data_.add_polygon(std::span(corners).first(element.corners), part);
            return;
        }
        HexCell cell;
        for (std::size_t i = 0; i < 8; ++i) cell[i] = VertexId(corners[i]);
        data_.hexahedra.push_back(cell);
        data_.hexahedron_parts.push_back(part);
    }

    const InputFile& file_;
    MeshData data_;
    Block block_ = Block::none;
    std::size_t position_ = 0;
    bool seen_keyword_ = false;
    bool last_keyword_is_instance_ = false;
    bool in_instance_ = false;
    bool in_assembly_ = false;
    bool generate_ = false;
    bool nested_sets_ = false;
    bool continued_ = false;  ///< a skipped element goes on in the next line
    int parts_ = 0;
    int instances_ = 0;
    int set_ = -1;
    std::size_t skipped_blocks_ = 0;
    std::size_t corners_ = 0;
    std::vector<long long> pending_;
    IdMap node_ids_, element_ids_;
    std::vector<std::size_t> node_positions_;
    std::vector<Element> elements_;
    std::map<std::string, std::vector<std::size_t>> skipped_keywords_;  // positions in the file
    std::vector<long long> skipped_ids_;
    ElementSets sets_;
    std::set<std::string> part_sets_;  ///< names in capitals
};

void append_nodes(OutputFile& out, std::span<const Vec3> points) {
    out.write("*HEADING\nwritten by hexspline\n*NODE\n");
    for (std::size_t v = 0; v < points.size(); ++v) {
        append_number(out.buffer(), v + 1);
        out.buffer() += ", ";
        append_point(out.buffer(), points[v], ',');
        out.buffer() += '\n';
        out.flush_if_large();
    }
}

template <class Corners>
void append_element(std::string& text, std::size_t id, const Corners& corners) {
    append_number(text, id);
    for (const std::size_t v : corners) {
        text += ", ";
        append_number(text, v + 1);
    }
    text += '\n';
}

/// The elements of each part, sixteen ids a line.
void append_sets(OutputFile& out, std::span<const int> parts, const PartNames& names) {
    std::map<int, std::vector<std::size_t>> members;
    for (std::size_t e = 0; e < parts.size(); ++e) members[parts[e]].push_back(e + 1);
    std::vector<int> distinct;
    for (const auto& [part, ids] : members) distinct.push_back(part);
    const PartNames set_names = abaqus_names(distinct, names);
    for (const auto& [part, ids] : members) {
        out.write("*ELSET, ELSET=" + set_names.at(part) + "\n");
        for (std::size_t i = 0; i < ids.size(); ++i) {
            append_number(out.buffer(), ids[i]);
            out.buffer() += i % 16 == 15 || i + 1 == ids.size() ? "\n" : ", ";
            out.flush_if_large();
        }
    }
}

}  // namespace

PartNames abaqus_names(std::span<const int> parts, const PartNames& names) {
    return distinct_names_within({",\"=*", "", 80}, parts, names);
}

MeshData read_abaqus(const InputFile& file) {
    return AbaqusReader(file).read();
}

void write_abaqus_surface(OutputFile& out, const PolygonSoup& soup, const PartNames& names) {
    append_nodes(out, soup.points);
    std::size_t before = 0;
    for (std::size_t f = 0; f < soup.size(); ++f) {
        const auto polygon = soup.polygon(f);
        // A new block where the number of corners changes keeps the order of the elements.
        if (polygon.size() != before)
            out.write(polygon.size() == 3 ? "*ELEMENT, TYPE=S3\n" : "*ELEMENT, TYPE=S4\n");
        before = polygon.size();
        append_element(out.buffer(), f + 1, polygon);
        out.flush_if_large();
    }
    if (has_parts(soup.parts) || !names.empty()) append_sets(out, soup.parts, names);
}

void write_abaqus_hexahedra(OutputFile& out, const HexMesh& mesh, const Fields& fields) {
    append_nodes(out, mesh.positions());
    out.write("*ELEMENT, TYPE=C3D8\n");
    for (const CellId c : mesh.cells()) {
        std::array<std::size_t, 8> corners{};
        for (std::size_t i = 0; i < 8; ++i) corners[i] = mesh.cell(c)[i].index();
        append_element(out.buffer(), c.index() + 1, corners);
        out.flush_if_large();
    }
    if (has_parts(mesh.parts()) || !fields.part_names.empty()) {
        std::vector<int> parts;
        for (const CellId c : mesh.cells()) parts.push_back(mesh.part(c));
        append_sets(out, parts, fields.part_names);
    }
}

}  // namespace hex::io
