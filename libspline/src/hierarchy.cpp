#include "spline_rows.h"

#include <hex/base/error.h>
#include <hex/base/parallel.h>
#include <spline/hierarchy.h>
#include <spline/subdivision.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <unordered_set>

namespace spline {

using hex::CellId;
using hex::Error;
using hex::ErrorKind;
using hex::VertexId;

namespace {

/// One flag a vertex: all elements of its support (its 2-ring) are flagged.
std::vector<char> support_inside(const LevelMesh& level, const std::vector<char>& cell_flags) {
    std::vector<char> star_inside(level.mesh.vertex_count());
    hex::parallel_for(star_inside.size(), [&](std::size_t v) {
        const auto star = level.stars[v];
        star_inside[v] = !star.empty() && std::all_of(star.begin(), star.end(),
                                                      [&](CellId c) { return cell_flags[c.index()] != 0; });
    });
    std::vector<char> ring_inside(level.mesh.cell_count());
    hex::parallel_for(ring_inside.size(), [&](std::size_t c) {
        const auto& corners = level.mesh.cell(CellId(c));
        ring_inside[c] = std::all_of(corners.begin(), corners.end(),
                                     [&](VertexId v) { return star_inside[v.index()] != 0; });
    });
    std::vector<char> inside(level.mesh.vertex_count());
    hex::parallel_for(inside.size(), [&](std::size_t v) {
        const auto star = level.stars[v];
        inside[v] = !star.empty() && std::all_of(star.begin(), star.end(),
                                                 [&](CellId c) { return ring_inside[c.index()] != 0; });
    });
    return inside;
}

std::vector<char> flags_of(std::size_t count, const std::vector<CellId>& cells) {
    std::vector<char> flags(count, 0);
    for (const CellId c : cells) flags[c.index()] = 1;
    return flags;
}

/// The other cells that share a vertex with a refined one, in the published order.
std::vector<CellId> cells_around(const LevelMesh& level, const std::vector<CellId>& refined) {
    std::vector<char> taken = flags_of(level.mesh.cell_count(), refined);
    std::vector<CellId> around;
    for (const CellId e : refined) {
        for (const VertexId v : level.mesh.cell(e)) {
            for (const CellId c : level.stars[v.index()]) {
                if (taken[c.index()] != 0) continue;
                taken[c.index()] = 1;
                around.push_back(c);
            }
        }
    }
    return around;
}

/// Builds level by level; where closure asks more of a coarser level it goes back to it. Lists only grow at
/// their ends, so ids of elements in the domain never change.
class Builder {
  public:
    Builder(LevelMesh coarsest, const std::vector<std::vector<std::int64_t>>& refinement, bool closure,
            const hex::Context& context)
        : closure_(closure), context_(context) {
        check_lists(coarsest, refinement);
        hierarchy_.levels.resize(1);
        hierarchy_.levels[0].domain_cells = coarsest.mesh.cell_count();
        hierarchy_.levels[0].control = std::move(coarsest);
    }

    Hierarchy build() {
        std::size_t l = 0;
        while (l < lists_.size() && !lists_[l].empty()) {
            context_.check_cancelled();
            context_.progress("refinement", static_cast<double>(l) / static_cast<double>(lists_.size()));
            HierarchyLevel& level = hierarchy_.levels[l];
            if (closure_ && !close(l)) {
                // Level l - 1 has to refine more: its mesh stands, this one is built again.
                hierarchy_.levels.resize(l);
                --l;
                continue;
            }
            level.refined = lists_[l];
            level.buffer = cells_around(level.control, level.refined);
            Subdivision next = subdivide(level.control, level.refined, level.buffer);
            HierarchyLevel finer;
            finer.control = std::move(next.fine);
            finer.coefficients = std::move(next.coefficients);
            finer.domain_cells = 8 * level.refined.size();
            hierarchy_.levels.push_back(std::move(finer));
            ++l;
        }
        for (std::size_t i = 0; i < lists_.size(); ++i)
            hierarchy_.added.push_back(lists_[i].size() - listed_[i]);
        activate();
        report();
        return std::move(hierarchy_);
    }

  private:
    /// Ids and parents are decided by the lists alone: refined cells come first in the next level's mesh.
    void check_lists(const LevelMesh& coarsest, const std::vector<std::vector<std::int64_t>>& refinement) {
        auto domain = static_cast<std::int64_t>(coarsest.mesh.cell_count());
        for (std::size_t l = 0; l < refinement.size(); ++l) {
            std::vector<CellId> list;
            std::unordered_set<std::int64_t> seen;
            std::vector<std::int64_t> wrong, twice;
            for (const std::int64_t id : refinement[l]) {
                if (id < 0 || id >= domain)
                    wrong.push_back(id);
                else if (!seen.insert(id).second)
                    twice.push_back(id);
                else
                    list.push_back(CellId(static_cast<std::size_t>(id)));
            }
            if (!wrong.empty()) {
                const std::string of_level = "elements of level " + std::to_string(l) + " to refine ";
                if (l == 0)
                    throw Error(ErrorKind::bad_input, of_level + "that do not exist: " + hex::list_ids(wrong),
                                {}, "ids are 0-based; the mesh has " + std::to_string(domain) + " elements");
                throw Error(ErrorKind::bad_input,
                            of_level + "whose parent is not refined: " + hex::list_ids(wrong), {},
                            "ids refer to the mesh of that level, whose elements 0 to " +
                                std::to_string(domain - 1) +
                                " are the children of the elements listed for level " +
                                std::to_string(l - 1) + ", eight each");
            }
            if (!twice.empty())
                hierarchy_.diagnostics.push_back(
                    {hex::Severity::warning, "duplicate-refinement",
                     "elements listed twice for level " + std::to_string(l) + ": " + hex::list_ids(twice),
                     "element", twice});
            domain = 8 * static_cast<std::int64_t>(list.size());
            listed_.push_back(list.size());
            lists_.push_back(std::move(list));
        }
    }

    /// Completes the list of level l. False when level l - 1 had to be completed first.
    bool close(std::size_t l) {
        const HierarchyLevel& level = hierarchy_.levels[l];
        const LevelMesh& control = level.control;
        const std::vector<char> regular = regular_vertices(control);
        std::vector<char> chosen = flags_of(control.mesh.cell_count(), lists_[l]);
        std::vector<char> vertex_done(control.mesh.vertex_count(), 0);
        std::vector<CellId> parents;
        for (std::size_t i = 0; i < lists_[l].size(); ++i) {
            const CellId e = lists_[l][i];
            for (const VertexId v : control.mesh.cell(e)) {
                if (vertex_done[v.index()] != 0) continue;
                vertex_done[v.index()] = 1;
                for (const CellId c : control.stars[v.index()]) {
                    if (c.index() >= level.domain_cells)
                        parents.push_back(
                            hierarchy_.levels[l - 1]
                                .buffer[c.index() / 8 - hierarchy_.levels[l - 1].refined.size()]);
                    else if (regular[v.index()] == 0 && chosen[c.index()] == 0) {
                        chosen[c.index()] = 1;
                        lists_[l].push_back(c);
                    }
                }
            }
        }
        if (parents.empty()) return true;
        std::sort(parents.begin(), parents.end());
        parents.erase(std::unique(parents.begin(), parents.end()), parents.end());
        lists_[l - 1].insert(lists_[l - 1].end(), parents.begin(), parents.end());
        return false;
    }

    void activate() {
        for (std::size_t l = 0; l < hierarchy_.levels.size(); ++l) {
            HierarchyLevel& level = hierarchy_.levels[l];
            const std::size_t cells = level.control.mesh.cell_count();
            std::vector<char> in_domain(cells, 0);
            std::fill_n(in_domain.begin(), level.domain_cells, 1);
            const std::vector<char> refined = flags_of(cells, level.refined);
            level.element_active.resize(cells);
            for (std::size_t c = 0; c < cells; ++c)
                level.element_active[c] = in_domain[c] != 0 && refined[c] == 0;
            level.function_determined = support_inside(level.control, in_domain);
            const std::vector<char> passive = support_inside(level.control, refined);
            const std::size_t vertices = level.control.mesh.vertex_count();
            level.function_active.resize(vertices);
            level.function.assign(vertices, no_function);
            for (std::size_t v = 0; v < vertices; ++v) {
                level.function_active[v] = level.function_determined[v] != 0 && passive[v] == 0;
                if (level.function_active[v] != 0)
                    level.function[v] = static_cast<std::uint32_t>(hierarchy_.function_count++);
            }
        }
    }

    void report() {
        for (std::size_t l = 0; l < hierarchy_.added.size(); ++l) {
            if (hierarchy_.added[l] == 0) continue;
            std::vector<std::int64_t> ids;
            for (std::size_t i = listed_[l]; i < lists_[l].size(); ++i) ids.push_back(lists_[l][i].value());
            hierarchy_.diagnostics.push_back({hex::Severity::note, "closure",
                                              std::to_string(ids.size()) + " elements of level " +
                                                  std::to_string(l) +
                                                  " refined besides those listed: " + hex::list_ids(ids),
                                              "element", ids});
        }
        for (std::size_t l = 1; l < hierarchy_.levels.size(); ++l) {
            const auto& determined = hierarchy_.levels[l].function_determined;
            if (std::find(determined.begin(), determined.end(), 1) != determined.end()) continue;
            hierarchy_.diagnostics.push_back(
                {hex::Severity::warning,
                 "no-new-function",
                 "refining level " + std::to_string(l - 1) +
                     " gives no new function: a function needs its whole support refined, inside the solid "
                     "2 x 2 x 2 elements",
                 "element",
                 {}});
        }
    }

    Hierarchy hierarchy_;
    std::vector<std::vector<CellId>> lists_;
    std::vector<std::size_t> listed_;
    bool closure_;
    const hex::Context& context_;
};

}  // namespace

Hierarchy build_hierarchy(LevelMesh coarsest, const std::vector<std::vector<std::int64_t>>& refinement,
                          bool closure, const hex::Context& context) {
    return Builder(std::move(coarsest), refinement, closure, context).build();
}

std::vector<SparseRows> truncation_operators(const Hierarchy& hierarchy) {
    std::vector<SparseRows> operators;
    operators.reserve(hierarchy.levels.size());
    for (std::size_t l = 0; l < hierarchy.levels.size(); ++l) {
        const HierarchyLevel& level = hierarchy.levels[l];
        const auto truncated_row = [&](std::size_t v, RealRowSum& row) {
            if (level.function_determined[v] != 0) {
                if (level.function_active[v] != 0) row.add(level.function[v], 1.0);
                return;
            }
            const SparseRow coefficients = level.coefficients[v];
            for (std::size_t i = 0; i < coefficients.size(); ++i) {
                const SparseRow below = operators[l - 1][coefficients.columns[i]];
                for (std::size_t j = 0; j < below.size(); ++j)
                    row.add(below.columns[j], coefficients.values[i] * below.values[j]);
            }
        };
        SparseRows rows = build_rows<RealRowSum>(level.control.mesh.vertex_count(), truncated_row);
        operators.push_back(std::move(rows));
    }
    return operators;
}

}  // namespace spline
