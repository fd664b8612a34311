#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <hex/io/number_text.h>
#include <hex/io/text_file.h>
#include <hex/quality/scaled_jacobian.h>
#include <spline/refine_region.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace spline {

using hex::BoundingBox;
using hex::CellId;
using hex::Error;
using hex::ErrorKind;
using hex::Vec3;

namespace {

BoundingBox box_of(const LevelMesh& level, std::size_t c) {
    BoundingBox box;
    for (const Vec3& p : level.mesh.corner_positions(CellId(c))) box.add(p);
    return box;
}

double distance(const BoundingBox& box, const Vec3& p) {
    return (p - p.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
}

template <class Test>
std::vector<std::int64_t> elements_where(std::size_t count, const Test& test) {
    std::vector<std::int64_t> found;
    for (std::size_t c = 0; c < count; ++c) {
        if (test(c)) found.push_back(static_cast<std::int64_t>(c));
    }
    return found;
}

/// For each point the element whose bounding box is nearest; of several, the one with the nearest centre.
std::vector<std::int64_t> elements_at(const std::vector<Vec3>& points, const LevelMesh& level,
                                      std::size_t count) {
    std::vector<BoundingBox> boxes(count);
    hex::parallel_for(count, [&](std::size_t c) { boxes[c] = box_of(level, c); });
    std::vector<std::int64_t> found(points.size());
    hex::parallel_for(
        points.size(),
        [&](std::size_t i) {
            double best = INFINITY, best_centre = INFINITY;
            for (std::size_t c = 0; c < count; ++c) {
                const double d = distance(boxes[c], points[i]);
                if (d > best) continue;
                const double centre = (0.5 * (boxes[c].lower + boxes[c].upper) - points[i]).norm();
                if (d == best && centre >= best_centre) continue;
                best = d;
                best_centre = centre;
                found[i] = static_cast<std::int64_t>(c);
            }
        },
        8);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

std::vector<std::int64_t> worst_elements(double share, const LevelMesh& level, std::size_t count) {
    std::vector<double> quality(count);
    hex::parallel_for(count,
                      [&](std::size_t c) { quality[c] = hex::scaled_jacobian(level.mesh, CellId(c)); });
    std::vector<std::int64_t> order(count);
    std::iota(order.begin(), order.end(), std::int64_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
        return quality[static_cast<std::size_t>(a)] < quality[static_cast<std::size_t>(b)];
    });
    order.resize(std::min(count, static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)))));
    std::sort(order.begin(), order.end());
    return order;
}

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorKind::usage, "'" + text + "' is nothing to refine", {},
                "use box:x0,y0,z0,x1,y1,z1[:level], sphere:x,y,z,radius[:level], near:FILE[:level], "
                "worst:N%[:level] or worst-fit:N%[:level]");
}

/// Exactly `count` numbers separated by commas.
std::vector<double> numbers_of(const std::string& list, std::size_t count, const std::string& text) {
    std::vector<double> numbers;
    std::istringstream stream(list);
    for (std::string item; std::getline(stream, item, ',');) {
        const auto value = hex::io::parse_double(item);
        if (!value) refuse(text);
        numbers.push_back(*value);
    }
    if (numbers.size() != count) refuse(text);
    return numbers;
}

void read_places(const std::string& path, RefineRegion& region) {
    std::istringstream file(hex::io::read_text_file(path));
    std::size_t number = 0;
    for (std::string line; std::getline(file, line);) {
        ++number;
        std::istringstream words(line.substr(0, line.find('#')));
        std::vector<std::string> fields;
        for (std::string word; words >> word;) fields.push_back(word);
        if (fields.empty()) continue;
        const std::string place = path + ":" + std::to_string(number);
        if (fields.size() == 1) {
            const auto patch = hex::io::parse_integer(fields[0]);
            if (!patch || *patch < 0 || *patch > std::numeric_limits<std::int32_t>::max())
                throw Error(ErrorKind::bad_input, "'" + fields[0] + "' is no patch number", place);
            region.patches.push_back(static_cast<std::int32_t>(*patch));
            region.patch_places.push_back(place);
            continue;
        }
        if (fields.size() != 3)
            throw Error(ErrorKind::bad_input, "a line must have three coordinates or one patch number",
                        place);
        Vec3 point;
        for (std::size_t a = 0; a < 3; ++a) {
            const auto value = hex::io::parse_double(fields[a]);
            if (!value) throw Error(ErrorKind::bad_input, "'" + fields[a] + "' is no coordinate", place);
            point[static_cast<Eigen::Index>(a)] = *value;
        }
        region.points.push_back(point);
    }
    if (region.points.empty() && region.patches.empty())
        throw Error(ErrorKind::bad_input, "has no points and no patch numbers", path);
    if (!region.points.empty() && !region.patches.empty())
        throw Error(ErrorKind::bad_input, "has both points and patch numbers", path);
    region.kind = region.patches.empty() ? RefineRegion::Kind::points : RefineRegion::Kind::patches;
}

}  // namespace

void require_patches(const RefineRegion& region, const LevelMesh& coarsest) {
    const auto& known = coarsest.patch_of_quad;  // numbers without gaps
    const auto count = known.empty() ? 0 : *std::max_element(known.begin(), known.end()) + 1;
    for (std::size_t i = 0; i < region.patches.size(); ++i) {
        if (region.patches[i] < count) continue;
        throw Error(ErrorKind::bad_input,
                    "there is no patch " + std::to_string(region.patches[i]) + "; there are " +
                        std::to_string(count) + ", counted from 0",
                    i < region.patch_places.size() ? region.patch_places[i] : std::string());
    }
}

std::vector<std::int64_t> elements_in(const RefineRegion& region, const LevelMesh& level,
                                      std::size_t domain_cells) {
    switch (region.kind) {
        case RefineRegion::Kind::box:
            return elements_where(domain_cells, [&](std::size_t c) {
                const BoundingBox box = box_of(level, c);
                return (box.lower.array() <= region.box.upper.array()).all() &&
                       (region.box.lower.array() <= box.upper.array()).all();
            });
        case RefineRegion::Kind::sphere:
            return elements_where(domain_cells, [&](std::size_t c) {
                return distance(box_of(level, c), region.center) <= region.radius;
            });
        case RefineRegion::Kind::points:
            return elements_at(region.points, level, domain_cells);
        case RefineRegion::Kind::patches:
            return elements_where(domain_cells, [&](std::size_t c) {
                for (int f = 0; f < 6; ++f) {
                    const hex::QuadId q =
                        level.boundary.quad_of_half_face[hex::HexMesh::half_face(CellId(c), f).index()];
                    if (q.valid() && std::find(region.patches.begin(), region.patches.end(),
                                               level.patch_of_quad[q.index()]) != region.patches.end())
                        return true;
                }
                return false;
            });
        case RefineRegion::Kind::worst_fit:
            return {};
        case RefineRegion::Kind::worst:
            break;
    }
    return worst_elements(region.share, level, domain_cells);
}

RefineRegion parse_region(const std::string& text) {
    RefineRegion region;
    const auto colon = text.find(':');
    if (colon == std::string::npos) refuse(text);
    const std::string kind = text.substr(0, colon);
    std::string what = text.substr(colon + 1);
    const auto last = what.rfind(':');
    if (last != std::string::npos) {
        const auto level = hex::io::parse_integer(what.substr(last + 1));
        if (level && *level >= 1 && *level <= 10) {
            region.level = static_cast<int>(*level);
            what.resize(last);
        } else if (kind != "near") {
            refuse(text);
        }
    }
    if (kind == "box") {
        const auto n = numbers_of(what, 6, text);
        region.box.add(Vec3(n[0], n[1], n[2]));
        region.box.add(Vec3(n[3], n[4], n[5]));
    } else if (kind == "sphere") {
        const auto n = numbers_of(what, 4, text);
        region.kind = RefineRegion::Kind::sphere;
        region.center = Vec3(n[0], n[1], n[2]);
        region.radius = n[3];
        if (!(region.radius >= 0.0)) refuse(text);
    } else if (kind == "near" && !what.empty()) {
        read_places(what, region);
    } else if ((kind == "worst" || kind == "worst-fit") && what.ends_with('%')) {
        what.pop_back();
        region.kind = kind == "worst" ? RefineRegion::Kind::worst : RefineRegion::Kind::worst_fit;
        region.share = numbers_of(what, 1, text)[0] / 100.0;
        if (!(region.share > 0.0 && region.share <= 1.0)) refuse(text);
    } else {
        refuse(text);
    }
    return region;
}

}  // namespace spline
