/// \file nastran_reader.cpp
/// Reads Nastran bulk data: GRID, CTRIA3, CQUAD4 and CHEXA with eight nodes, in small, large and free fields.
/// The part id is the property id. Points, bars, springs and the like are skipped with a warning, other
/// solids and points in coordinate systems of their own are errors; everything else says nothing about the
/// mesh.
///
///     hexspline convert -i part.bdf -o part.vtk --plugin nastran_reader.so
///
/// Source: MSC Nastran Quick Reference Guide, chapters on the format of bulk data entries, GRID, CHEXA,
/// CQUAD4, CTRIA3.

#include <hex/base/error.h>
#include <hex/base/plugin.h>
#include <hex/io/number_text.h>
#include <hex/io/reader.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <unordered_map>

namespace {

/// One entry of the bulk data: its fields behind the name, those of its continuations too.
struct Card {
    std::string name;
    std::vector<std::string> fields;
    std::size_t line = 0;
};

std::string trimmed(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return std::string(text);
}

std::string upper(std::string text) {
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return text;
}

/// The fields of one line, the name (or mark of continuation) first. A mark of continuation at the end of the
/// line is left out.
std::vector<std::string> fields_of(std::string_view line) {
    std::vector<std::string> fields;
    if (line.find(',') != std::string_view::npos) {
        for (std::size_t start = 0; start <= line.size() && fields.size() < 9;) {
            const std::size_t end = std::min(line.find(',', start), line.size());
            fields.push_back(trimmed(line.substr(start, end - start)));
            start = end + 1;
        }
    } else {
        fields.push_back(trimmed(line.substr(0, 8)));
        const bool wide = fields.front().find('*') != std::string::npos;
        const std::size_t width = wide ? 16 : 8;
        for (std::size_t start = 8; start < 72; start += width)
            fields.push_back(start < line.size() ? trimmed(line.substr(start, width)) : std::string());
    }
    const bool wide = fields.front().find('*') != std::string::npos;
    fields.resize(wide ? 5 : 9);
    return fields;
}

class NastranFile {
  public:
    NastranFile(const std::string& name, std::string_view bytes) : name_(name), bytes_(bytes) {}

    hex::io::MeshData read() {
        split_into_cards();
        for (const Card& card : cards_) {
            if (card.name == "GRID") take_point(card);
        }
        for (const Card& card : cards_) take_element(card);
        if (points_.empty()) fail(1, "no GRID entry: this is no Nastran bulk data");
        for (const auto& [kind, count] : skipped_)
            data_.warn("elements-skipped",
                       std::to_string(count) + " elements of type " + kind + " are skipped");
        return std::move(data_);
    }

  private:
    [[noreturn]] void fail(std::size_t line, const std::string& what,
                           hex::ErrorKind kind = hex::ErrorKind::bad_input,
                           const std::string& advice = {}) const {
        throw hex::Error(kind, what, name_ + ":" + std::to_string(line), advice);
    }

    void split_into_cards() {
        std::size_t number = 0;
        for (std::size_t start = 0; start < bytes_.size();) {
            const std::size_t end = std::min(bytes_.find('\n', start), bytes_.size());
            std::string_view line = bytes_.substr(start, end - start);
            start = end + 1;
            ++number;
            if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
            line = line.substr(0, line.find('$'));
            const std::string text = upper(trimmed(line));
            if (text.empty()) continue;
            if (text.starts_with("BEGIN") && text.ends_with("BULK")) {
                // What came before was about running the analysis.
                cards_.clear();
                continue;
            }
            if (text == "ENDDATA") return;
            take_line(line, number);
        }
    }

    void take_line(std::string_view line, std::size_t number) {
        std::vector<std::string> fields = fields_of(line);
        std::string first = upper(fields.front());
        const bool continues = first.empty() || first.front() == '+' || first.front() == '*';
        fields.erase(fields.begin());
        if (!continues) {
            if (first.back() == '*') first.pop_back();
            cards_.push_back({first, std::move(fields), number});
        } else if (!cards_.empty()) {
            auto& before = cards_.back().fields;
            before.insert(before.end(), fields.begin(), fields.end());
        }
    }

    static std::string field(const Card& card, std::size_t i) {
        return i < card.fields.size() ? card.fields[i] : std::string();
    }

    long long id(const Card& card, std::size_t i, const char* what) const {
        const auto value = hex::io::parse_integer(field(card, i));
        if (!value || *value < 1)
            fail(card.line, card.name + ": " + what + " should be a positive integer, not '" +
                                field(card, i).substr(0, 40) + "'");
        return *value;
    }

    /// Nastran leaves the E out ("1.5-3") and knows D for double precision; nothing is zero.
    double real(const Card& card, std::size_t i) const {
        std::string text = field(card, i);
        if (text.empty()) return 0.0;
        std::replace_if(
            text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
        const std::size_t sign = text.find_last_of("+-");
        if (sign != std::string::npos && sign > 0 && text[sign - 1] != 'e' && text[sign - 1] != 'E')
            text.insert(sign, "e");
        const auto value = hex::io::parse_double(text);
        if (!value)
            fail(card.line, card.name + ": a coordinate should be a finite number, not '" +
                                field(card, i).substr(0, 40) + "'");
        return *value;
    }

    void take_point(const Card& card) {
        const long long name = id(card, 0, "the point");
        const std::string system = field(card, 1);
        if (!system.empty() && system != "0")
            fail(card.line, "point " + std::to_string(name) + " is in coordinate system " + system,
                 hex::ErrorKind::unsupported, "save the points in the basic system");
        if (!points_.emplace(name, static_cast<std::uint32_t>(data_.points().size())).second)
            fail(card.line, "point " + std::to_string(name) + " is there a second time");
        data_.points().emplace_back(real(card, 2), real(card, 3), real(card, 4));
    }

    void take_element(const Card& card) {
        const std::string& kind = card.name;
        if (kind == "CTRIA3") return polygon(card, 3);
        if (kind == "CQUAD4") return polygon(card, 4);
        if (kind == "CHEXA" || kind == "CHEXA8") return hexahedron(card);
        if (kind == "CTETRA" || kind == "CPENTA" || kind == "CPYRAM" || kind == "CTRIA6" || kind == "CQUAD8")
            fail(card.line, kind + " elements are not supported", hex::ErrorKind::unsupported,
                 "CTRIA3, CQUAD4 and CHEXA with eight nodes are read");
        static const std::set<std::string> without_faces = {"CBAR",   "CBEAM",  "CBUSH",  "CROD",
                                                            "CONROD", "CELAS1", "CELAS2", "CONM2"};
        if (without_faces.contains(kind)) ++skipped_[kind];
    }

    /// The corners of an element, from its third field on.
    template <std::size_t Count>
    std::array<std::uint32_t, Count> corners(const Card& card) {
        const long long element = id(card, 0, "the element");
        if (!elements_.insert(element).second)
            fail(card.line, "element " + std::to_string(element) + " is there a second time");
        std::array<std::uint32_t, Count> result{};
        for (std::size_t i = 0; i < Count; ++i) {
            const long long name = id(card, 2 + i, "a point");
            const auto found = points_.find(name);
            if (found == points_.end())
                fail(card.line, "element " + std::to_string(element) + " has point " + std::to_string(name) +
                                    ", which is not there");
            result[i] = found->second;
        }
        return result;
    }

    /// Without a property the part is that of the element's number, as Nastran has it.
    int part(const Card& card) const {
        const long long property =
            field(card, 1).empty() ? id(card, 0, "the element") : id(card, 1, "the property");
        if (property > INT32_MAX) fail(card.line, "the property id is too large");
        return static_cast<int>(property);
    }

    void polygon(const Card& card, std::size_t count) {
        if (count == 3)
            data_.add_polygon(corners<3>(card), part(card));
        else
            data_.add_polygon(corners<4>(card), part(card));
    }

    void hexahedron(const Card& card) {
        for (std::size_t i = 10; i < card.fields.size(); ++i)
            if (!card.fields[i].empty())
                fail(card.line, "a CHEXA with nodes on its edges", hex::ErrorKind::unsupported,
                     "save elements of first order");
        hex::HexCell cell;
        const auto points = corners<8>(card);
        for (std::size_t i = 0; i < 8; ++i) cell[i] = hex::VertexId(points[i]);
        data_.hexahedra.push_back(cell);
        data_.hexahedron_parts.push_back(part(card));
    }

    const std::string& name_;
    std::string_view bytes_;
    std::vector<Card> cards_;
    std::unordered_map<long long, std::uint32_t> points_;
    std::set<long long> elements_;
    std::map<std::string, std::size_t> skipped_;
    hex::io::MeshData data_;
};

class NastranReader : public hex::io::Reader {
  public:
    hex::io::MeshData read(const std::string& name, std::string_view bytes) const override {
        return NastranFile(name, bytes).read();
    }
};

void register_methods() {
    for (const char* extension : {".bdf", ".nas"})
        hex::io::add_reader(extension, "Nastran bulk data", [] { return std::make_unique<NastranReader>(); });
}

}  // namespace

HEX_PLUGIN("nastran-reader", "1.0", register_methods)
