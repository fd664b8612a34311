/// \file small_files.h
/// Files whose text stands in the test.
#pragma once

#include "support/test_files.h"

#include <hex/io/mesh_file.h>

#include <string>

namespace hex::io {

inline SurfaceFile surface_of(const std::string& extension, const std::string& text) {
    const test::TemporaryFolder folder;
    test::write_text(folder / ("a" + extension), text);
    return read_surface(folder / ("a" + extension));
}

inline HexFile hexahedra_of(const std::string& extension, const std::string& text) {
    const test::TemporaryFolder folder;
    test::write_text(folder / ("a" + extension), text);
    return read_hex_mesh(folder / ("a" + extension));
}

}  // namespace hex::io
