// Gmsh meshes (.msh, .msh2), versions 2.2 and 4.1, ASCII and binary: triangles, quadrilaterals, hexahedra;
// physical groups are parts.
#include "io/formats.h"
#include "io/gmsh_numbers.h"
#include "io/id_map.h"

#include <hex/base/diagnostics.h>
#include <hex/base/error.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace hex::io {
namespace {

/// Corners of Gmsh's element types that are read; 0 for points and lines.
std::optional<std::size_t> corners_of(int type) {
    switch (type) {
        case 1:
        case 15:
            return 0;
        case 2:
            return 3;
        case 3:
            return 4;
        case 5:
            return 8;
        default:
            return std::nullopt;
    }
}

/// Nodes of the types that are skipped.
std::size_t nodes_of_skipped(int type) {
    return type == 1 ? 2 : 1;
}

struct Element {
    long long tag;
    std::array<long long, 8> nodes;
    std::size_t corners;
    int group;   ///< the physical group; 0 without
    int entity;  ///< of the geometry
    std::size_t position;
    int part = 0;

    int dimension() const { return corners == 8 ? 3 : 2; }
};

class GmshReader {
  public:
    explicit GmshReader(const InputFile& file) : numbers_(file), scanner_(numbers_.text()) {}

    MeshData read() {
        if (scanner_.word("$MeshFormat") != "$MeshFormat")
            scanner_.fail("not a Gmsh mesh: it does not start with $MeshFormat");
        format();
        while (!scanner_.at_end()) section(std::string(scanner_.word("a section")));
        if (!has_nodes_) scanner_.fail("the file has no $Nodes");
        finish();
        return std::move(data_);
    }

  private:
    void format() {
        const std::string version(scanner_.word("the version"));
        if (version != "2.2" && version != "2" && version != "4.1")
            scanner_.unsupported("Gmsh format " + in_quotes(version) + " is not supported",
                                 "2.2 and 4.1 can be read");
        new_layout_ = version == "4.1";
        const long long type = scanner_.integer("the file type");
        if (type != 0 && type != 1)
            scanner_.fail("the file type should be 0 or 1, not " + std::to_string(type));
        const long long size = scanner_.integer("the size of a number");
        if (type == 1) {
            if (size != 8)
                scanner_.unsupported("binary numbers of " + std::to_string(size) + " bytes", "8 can be read");
            numbers_.start_binary(new_layout_);
        }
        end("$EndMeshFormat");
    }

    void end(const char* name) {
        const auto word = scanner_.word(name);
        if (word != name) scanner_.fail(std::string(name) + " should be here, not " + in_quotes(word));
    }

    void section(const std::string& name) {
        if (name == "$PhysicalNames") return physical_names();
        if (name == "$Entities" && new_layout_) return entities(false);
        if (name == "$PartitionedEntities" && new_layout_) return entities(true);
        if (name == "$Nodes") return new_layout_ ? nodes_in_blocks() : nodes();
        if (name == "$Elements") return new_layout_ ? elements_in_blocks() : elements();
        if (!name.starts_with("$")) scanner_.fail("a section should be here, not " + in_quotes(name));
        static constexpr std::array<std::string_view, 4> harmless = {"$Comments", "$NodeData", "$ElementData",
                                                                     "$ElementNodeData"};
        if (std::find(harmless.begin(), harmless.end(), name) == harmless.end())
            data_.warn("unknown-keyword", "section " + in_quotes(name) + " is skipped");
        const std::string last = "$End" + name.substr(1);
        scanner_.rest_of_line();
        while (scanner_.rest_of_line() != last) {
            if (scanner_.position() >= scanner_.text().size()) scanner_.fail("the file ends within " + name);
        }
    }

    void physical_names() {
        const std::size_t count = scanner_.count("the number of names", 6);
        for (std::size_t i = 0; i < count; ++i) {
            const int dimension = scanner_.small_integer("a dimension");
            const int tag = scanner_.small_integer("a physical tag");
            std::string_view name = scanner_.rest_of_line();
            if (name.size() < 2 || name.front() != '"' || name.back() != '"')
                scanner_.fail("a name in quotes should be here, not " + in_quotes(name));
            name = name.substr(1, name.size() - 2);
            names_[{dimension, tag}] = std::string(name);
        }
        end("$EndPhysicalNames");
    }

    /// Of each entity its physical group, and the entity of the geometry it is a part of. A file that is cut
    /// into partitions has two such sections; its elements belong to the entities of the second.
    void entities(bool partitioned) {
        numbers_.next_line();
        if (partitioned) {
            groups_.clear();
            numbers_.size("the number of partitions");
            const std::size_t ghosts = numbers_.count("the number of ghost entities", 4);
            for (std::size_t i = 0; i < 2 * ghosts; ++i) numbers_.integer("a ghost entity");
        }
        std::array<std::size_t, 4> counts{};
        for (auto& count : counts) count = numbers_.count("the number of entities", 4);
        for (int dimension = 0; dimension < 4; ++dimension)
            for (std::size_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i)
                entity(dimension, partitioned);
        end(partitioned ? "$EndPartitionedEntities" : "$EndEntities");
    }

    void entity(int dimension, bool partitioned) {
        const int tag = numbers_.small_integer("the tag of an entity");
        int parent = tag;
        if (partitioned) {
            const bool same = numbers_.integer("the dimension of the parent") == dimension;
            const int parent_tag = numbers_.small_integer("the tag of the parent");
            if (same) parent = parent_tag;
            const std::size_t partitions = numbers_.count("the number of partitions", 2);
            for (std::size_t k = 0; k < partitions; ++k) numbers_.integer("a partition");
        }
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) numbers_.real("a coordinate");
        const std::size_t groups = numbers_.count("the number of physical groups", 2);
        int first = 0;
        for (std::size_t g = 0; g < groups; ++g) {
            const int physical = numbers_.small_integer("a physical tag");
            if (g == 0) first = physical;
        }
        if (dimension >= 2 && groups > 1) ++entities_in_several_groups_;
        groups_[{dimension, tag}] = {group_named(first), parent};
        if (dimension == 0) return;
        const std::size_t bounding = numbers_.count("the number of bounding entities", 2);
        for (std::size_t b = 0; b < bounding; ++b) numbers_.integer("a bounding entity");
    }

    /// A minus only says that the group sees the entity from its other side.
    int group_named(int physical) const {
        if (physical == INT_MIN) numbers_.fail("a physical tag is too small");
        return std::abs(physical);
    }

    void start_nodes() {
        if (has_nodes_) numbers_.fail("$Nodes a second time");
        has_nodes_ = true;
    }

    void add_node(long long tag, const Vec3& point) {
        node_tags_.add(tag);
        data_.points().push_back(point);
    }

    void nodes() {
        start_nodes();
        const std::size_t count = scanner_.count("the number of nodes", 8);
        numbers_.next_line();
        data_.points().reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const long long tag = numbers_.positive("a node tag");
            add_node(tag, numbers_.point());
        }
        finish_nodes();
    }

    void finish_nodes() {
        end("$EndNodes");
        const std::size_t twice = node_tags_.finish();
        if (twice < node_tags_.size())
            numbers_.fail("node " + std::to_string(node_tags_.id(twice)) + " is defined twice");
    }

    /// How many blocks a section of version 4 has, and how many nodes or elements of at least `bytes` they
    /// hold.
    std::pair<std::size_t, std::size_t> block_counts(const char* what, std::size_t bytes) {
        numbers_.next_line();
        const std::size_t blocks = numbers_.count("the number of blocks", 8);
        const std::size_t count = numbers_.count(what, bytes);
        numbers_.size("the smallest tag");
        numbers_.size("the largest tag");
        return {blocks, count};
    }

    void nodes_in_blocks() {
        start_nodes();
        const auto [blocks, count] = block_counts("the number of nodes", 8);
        data_.points().reserve(count);
        std::vector<long long> tags;
        for (std::size_t b = 0; b < blocks; ++b) {
            const long long dimension = numbers_.integer("a dimension");
            numbers_.integer("the tag of an entity");
            const bool parametric = numbers_.integer("whether there are parameters") != 0;
            const std::size_t size = numbers_.count("the number of nodes", 8);
            tags.clear();
            for (std::size_t i = 0; i < size; ++i) tags.push_back(numbers_.positive("a node tag"));
            for (std::size_t i = 0; i < size; ++i) {
                add_node(tags[i], numbers_.point());
                for (long long k = 0; parametric && k < dimension; ++k) numbers_.real("a parameter");
            }
        }
        if (data_.points().size() != count)
            numbers_.fail("there are " + std::to_string(data_.points().size()) + " nodes, not " +
                          std::to_string(count));
        finish_nodes();
    }

    std::size_t corners_or_fail(int type) const {
        const auto corners = corners_of(type);
        if (!corners)
            numbers_.unsupported("elements of Gmsh's type " + std::to_string(type) + " are not supported",
                                 "triangles, quadrilaterals and hexahedra of first order are read");
        return *corners;
    }

    void take_element(long long tag, int type, std::size_t corners, int group, int entity) {
        Element element{tag, {}, corners, group, entity, numbers_.position()};
        if (corners == 0) {
            for (std::size_t i = 0; i < nodes_of_skipped(type); ++i) numbers_.size("a node tag");
            ++skipped_;
            return;
        }
        for (std::size_t i = 0; i < corners; ++i) element.nodes[i] = numbers_.size("a node tag");
        elements_.push_back(element);
    }

    void start_elements() {
        if (has_elements_) numbers_.fail("$Elements a second time");
        has_elements_ = true;
    }

    void elements() {
        start_elements();
        const std::size_t count = scanner_.count("the number of elements", 8);
        numbers_.next_line();
        for (std::size_t done = 0; done < count;) {
            if (!numbers_.binary()) {
                const long long tag = numbers_.positive("an element tag");
                const int type = numbers_.small_integer("an element type");
                take_element_with_tags(tag, type, numbers_.count("the number of tags", 2));
                ++done;
                continue;
            }
            const int type = numbers_.small_integer("an element type");
            const std::size_t size = numbers_.count("the number of elements", 8);
            const std::size_t tags = numbers_.count("the number of tags", 2);
            if (size == 0 || size > count - done)
                numbers_.fail("there are not " + std::to_string(count) + " elements");
            for (std::size_t i = 0; i < size; ++i)
                take_element_with_tags(numbers_.positive("an element tag"), type, tags);
            done += size;
        }
        end("$EndElements");
    }

    /// The tags are the physical group, then the geometric entity; 0 is no group.
    void take_element_with_tags(long long tag, int type, std::size_t tags) {
        const std::size_t corners = corners_or_fail(type);
        int physical = 0, entity = 1;
        for (std::size_t t = 0; t < tags; ++t) {
            const int value = numbers_.small_integer("a tag");
            if (t == 0) physical = value;
            if (t == 1) entity = value;
        }
        take_element(tag, type, corners, group_named(physical), entity);
    }

    void elements_in_blocks() {
        start_elements();
        const auto [blocks, count] = block_counts("the number of elements", 4);
        std::size_t found = 0;
        for (std::size_t b = 0; b < blocks; ++b) {
            const int dimension = numbers_.small_integer("a dimension");
            const int entity = numbers_.small_integer("the tag of an entity");
            const int type = numbers_.small_integer("an element type");
            const std::size_t corners = corners_or_fail(type);
            const std::size_t size = numbers_.count("the number of elements", 4);
            const auto known = groups_.find({dimension, entity});
            const auto [group, parent] = known == groups_.end() ? std::pair(0, entity) : known->second;
            for (std::size_t i = 0; i < size; ++i)
                take_element(numbers_.positive("an element tag"), type, corners, group, parent);
            found += size;
        }
        if (found != count)
            numbers_.fail("there are " + std::to_string(found) + " elements, not " + std::to_string(count));
        end("$EndElements");
    }

    /// Version 2.2 writes an element once for each of its groups; version 4.1 names the groups of an entity.
    void drop_copies() {
        const auto is_of_first = [&](const Element& element) {
            return element.group == elements_.front().group;
        };
        const bool may_overlap =
            !new_layout_ && !std::all_of(elements_.begin(), elements_.end(), is_of_first);
        std::vector<std::uint32_t> order(may_overlap ? elements_.size() : 0);
        std::iota(order.begin(), order.end(), 0U);
        const auto place = [&](std::uint32_t e) {
            return std::tie(elements_[e].corners, elements_[e].entity, elements_[e].nodes);
        };
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::tuple_cat(place(a), std::tie(a)) < std::tuple_cat(place(b), std::tie(b));
        });
        std::vector<char> is_copy(elements_.size(), 0);
        for (std::size_t i = 1; i < order.size(); ++i)
            if (place(order[i]) == place(order[i - 1]) &&
                elements_[order[i]].group != elements_[order[i - 1]].group)
                is_copy[order[i]] = 1;
        const auto copies = static_cast<std::size_t>(std::count(is_copy.begin(), is_copy.end(), 1));
        if (copies > 0) {
            std::size_t e = 0;
            std::erase_if(elements_, [&](const Element&) { return is_copy[e++] != 0; });
        }
        if (copies + entities_in_several_groups_ > 0)
            data_.warn("groups-overlap",
                       "physical groups overlap: an element belongs to the first that has it");
    }

    /// A part is a physical group; what is in none is a part by its entity, under another number where that
    /// is one of a group.
    void number_parts() {
        std::set<std::pair<int, int>> taken, alone;
        for (const auto& [key, name] : names_) taken.insert(key);
        for (const Element& element : elements_) {
            if (element.group != 0)
                taken.insert({element.dimension(), element.group});
            else
                alone.insert({element.dimension(), element.entity});
        }
        std::map<std::pair<int, int>, int> part_of_entity;
        std::vector<std::pair<int, int>> doubtful;
        for (const auto& entity : alone) {
            if (taken.contains(entity))
                doubtful.push_back(entity);
            else
                part_of_entity[entity] = entity.second;
        }
        taken.merge(alone);
        std::vector<std::int64_t> renumbered;
        std::pair<int, int> next{0, 1};
        for (const auto& entity : doubtful) {
            if (next.first != entity.first) next = {entity.first, 1};
            while (taken.contains(next)) ++next.second;
            part_of_entity[entity] = next.second++;
            renumbered.push_back(entity.second);
        }
        for (Element& element : elements_)
            element.part =
                element.group != 0 ? element.group : part_of_entity[{element.dimension(), element.entity}];
        if (!renumbered.empty())
            data_.warn("parts-renumbered",
                       "elements in no physical group get new part ids where their entity has the number of "
                       "a group: entity " +
                           list_ids(renumbered),
                       "entity", renumbered);
    }

    /// In the order of their tags: files of version 4 hold them part by part.
    void finish() {
        drop_copies();
        number_parts();
        std::vector<std::uint32_t> order(elements_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(elements_[a].tag, a) < std::pair(elements_[b].tag, b);
        });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Element& element = elements_[order[i]];
            if (i > 0 && elements_[order[i - 1]].tag == element.tag)
                fail_at(element, "element " + std::to_string(element.tag) + " is defined twice");
            add(element);
        }
        if (skipped_ > 0)
            data_.warn("elements-skipped", std::to_string(skipped_) + " points and lines are skipped");
        for (const auto& [key, name] : names_) {
            if (key.first == (data_.hexahedra.empty() ? 2 : 3) &&
                name != "PART_" + std::to_string(key.second))
                data_.part_names[key.second] = name;
        }
    }

    [[noreturn]] void fail_at(const Element& element, const std::string& what) const {
        numbers_.fail_at(element.position, what);
    }

    void add(const Element& element) {
        std::array<std::uint32_t, 8> corners{};
        for (std::size_t i = 0; i < element.corners; ++i) {
            const std::size_t v = node_tags_.find(element.nodes[i]);
            if (v == node_tags_.size())
                fail_at(element, "element " + std::to_string(element.tag) + " uses node " +
                                     std::to_string(element.nodes[i]) + ", which the file does not define");
            corners[i] = static_cast<std::uint32_t>(v);
        }
        if (element.corners < 8) {
            data_.add_polygon(std::span(corners).first(element.corners), element.part);
            return;
        }
        HexCell cell;
        for (std::size_t i = 0; i < 8; ++i) cell[i] = VertexId(corners[i]);
        data_.hexahedra.push_back(cell);
        data_.hexahedron_parts.push_back(element.part);
    }

    GmshNumbers numbers_;
    TextScanner& scanner_;
    MeshData data_;
    bool new_layout_ = false;
    bool has_nodes_ = false;
    bool has_elements_ = false;
    std::size_t skipped_ = 0;
    std::size_t entities_in_several_groups_ = 0;
    IdMap node_tags_;
    std::vector<Element> elements_;
    std::map<std::pair<int, int>, std::string> names_;           ///< of groups, by dimension and tag
    std::map<std::pair<int, int>, std::pair<int, int>> groups_;  ///< of entities: group and parent
};

}  // namespace

MeshData read_gmsh(const InputFile& file) {
    return GmshReader(file).read();
}

}  // namespace hex::io
