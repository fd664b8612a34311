/// \file cad_file.h
/// CAD models as triangle surfaces, through Open CASCADE.
#pragma once

#include <hex/io/surface_file.h>

#include <filesystem>

namespace hex::io {

/// How finely the faces of a CAD model become triangles, and which of its edges are sharp.
struct CadOptions {
    /// How far a triangle may leave its face, in the units of the model (millimetres for STEP and IGES); 0
    /// takes 0.0005 of the diagonal.
    double deflection = 0.0;
    /// The largest turn of the normal along a curved edge from one segment to the next, in degrees.
    double angle = 15.0;
    /// Longer edges are cut, for stages that decide triangle by triangle; 0 takes 0.05 of the diagonal,
    /// infinity leaves them.
    double longest_edge = 0.0;
    /// An edge between faces whose normals differ by more than this, in degrees, is sharp.
    double sharp_angle = 10.0;
};

/// The extension is one of a CAD format (.step .stp .iges .igs .brep), whether or not it can be read.
bool is_cad_file(const std::filesystem::path& path);

/// Reads the solids of a CAD file: each face as triangles with the number of the face (from 1) as part,
/// joined exactly along common edges and vertices, oriented outwards, and the sharp edges of the model with
/// them. Several solids become several components. A file without solids (most IGES files) has its faces sewn
/// together first. Deterministic.
///
/// Diagnostics: notes `solids`, `open-shell` (the triangles have boundaries there), warnings
/// `shells-skipped`, `face-without-area`. Whether the surface is closed and manifold is not asked here.
///
/// Throws Error{bad_input} for what is not of the format, ends early, or holds no faces; Error{unsupported}
/// in a build without Open CASCADE.
SurfaceFile read_cad(const std::filesystem::path& path, const CadOptions& options = {});

}  // namespace hex::io
