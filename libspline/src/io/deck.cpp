#include "face_points.h"

#include <hex/base/error.h>
#include <hex/io/number_text.h>
#include <hex/io/output_file.h>
#include <spline/io/deck.h>

#include <algorithm>
#include <vector>

namespace spline::io {
namespace {

using hex::io::append_number;

/// Control points of each patch, ascending.
std::vector<std::vector<std::uint32_t>> patch_functions(const BezierSpline& spline) {
    std::vector<std::vector<std::uint32_t>> functions;
    for (std::size_t e = 0; e < spline.boundary_patch.size(); ++e) {
        for (std::size_t f = 0; f < 6; ++f) {
            if (spline.boundary_patch[e][f] < 0) continue;
            const auto patch = static_cast<std::size_t>(spline.boundary_patch[e][f]);
            if (functions.size() <= patch) functions.resize(patch + 1);
            for (const std::size_t p : face_points(f)) {
                const SparseRow row = spline.rows[spline.elements[e][p]];
                functions[patch].insert(functions[patch].end(), row.columns.begin(), row.columns.end());
            }
        }
    }
    for (auto& list : functions) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return functions;
}

/// Numbers of a card, separated by commas.
template <class... Numbers>
void card(std::string& text, Numbers... numbers) {
    bool first = true;
    ((text += first ? "" : ",", first = false, append_number(text, numbers)), ...);
    text += '\n';
}

}  // namespace

void write_deck(const std::filesystem::path& path, const BezierSpline& spline, const DeckOptions& options) {
    if (!(options.density > 0.0 && options.young > 0.0 && options.poisson > -1.0 && options.poisson < 0.5))
        throw hex::Error(hex::ErrorKind::usage,
                         "density and Young's modulus must be positive, Poisson's ratio in (-1, 0.5)");
    const auto patches = patch_functions(spline);
    const bool fixed = options.kind == DeckKind::linear_static;
    if (fixed && patches.size() < 2)
        throw hex::Error(hex::ErrorKind::bad_input,
                         "a static deck needs two boundary patches, one to hold and one to load", {},
                         "give the part sharp features (-s), or use --deck eigen");
    hex::io::OutputFile file(path);
    std::string& text = file.buffer();
    text += "*KEYWORD\n*TITLE\n";
    text += fixed ? "Static analysis of a spline solid\n" : "Modes of a free spline solid\n";
    if (options.bext2)
        text += "*IGA_INCLUDE_BEZIER\n" + options.bext + "\n";
    else
        text += "*INCLUDE_TRANSFORM\n" + options.bext + "\n1,0,1,0,0\n\n\n\n";
    text += "*PART\nspline solid\n1,1,1\n*SECTION_SOLID\n1,201\n*MAT_ELASTIC\n";
    card(text, 1, options.density, options.young, options.poisson);
    text += "*CONTROL_IMPLICIT_GENERAL\n1,1.\n";
    if (fixed) {
        text += "*CONTROL_TERMINATION\n1.\n*CONTROL_IMPLICIT_SOLUTION\n1\n*DATABASE_BINARY_D3PLOT\n1.\n";
        text += "$ the first patch is held in x, y and z\n*BOUNDARY_SPC_SET\n1,0,1,1,1,0,0,0\n";
        text +=
            "$ each control point of the last patch is pulled by 1 along z\n*DEFINE_CURVE\n1\n0.,0.\n1.,1.\n";
        text += "*LOAD_NODE_SET\n";
        card(text, patches.size(), 3, 1, 1.0);
    } else {
        text += "*CONTROL_IMPLICIT_EIGENVALUE\n20\n";
    }
    for (std::size_t p = 0; p < patches.size(); ++p) {
        text += "$ patch ";
        append_number(text, p);
        text += "\n*SET_NODE_LIST\n";
        append_number(text, p + 1);
        text += '\n';
        for (std::size_t i = 0; i < patches[p].size(); ++i) {
            append_number(text, patches[p][i] + 1);
            text += i % 8 == 7 || i + 1 == patches[p].size() ? '\n' : ',';
        }
        file.flush_if_large();
    }
    text += "*END\n";
    file.commit();
}

}  // namespace spline::io
