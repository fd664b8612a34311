// Files cut off or damaged anywhere: a mesh or one line with its place, quickly, and without much memory.
#include "support/damage.h"
#include "support/meshes.h"
#include "support/test_files.h"

#include <hex/base/error.h>
#include <hex/io/mesh_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

namespace hex::io {
namespace {

using test::TemporaryFolder;

/// Files of every format and encoding that we can make.
std::vector<std::pair<std::string, std::string>> good_files() {
    const TemporaryFolder folder;
    std::vector<std::pair<std::string, std::string>> files;
    const auto keep = [&](const std::string& extension) {
        files.emplace_back(extension, test::read_text(folder / std::string("a").append(extension)));
    };
    for (const FormatInfo& info : formats()) {
        if (!info.writes_surfaces) continue;
        const std::string extension(info.extensions.front());
        write_surface(folder / std::string("a").append(extension), test::box_surface(1, 2, 3));
        keep(extension);
        if (!info.writes_hexahedra) continue;
        const HexMesh grid = test::grid(2, 1, 1);
        write_hex_mesh(folder / std::string("a").append(extension), grid);
        keep(extension);
    }
    return files;
}

/// Numbers of points, polygons and hexahedra.
std::array<std::size_t, 3> counts(const MeshFile& file) {
    if (const auto* surface = std::get_if<SurfaceFile>(&file))
        return {surface->soup.points.size(), surface->soup.size(), 0};
    const HexMesh& mesh = std::get<HexFile>(file).mesh;
    return {mesh.vertex_count(), 0, mesh.cell_count()};
}

TEST(TruncatedFile, NeverCrashesAndNeverLosesElementsSilently) {
    const TemporaryFolder folder;
    for (const auto& [extension, text] : good_files()) {
        // OBJ and Abaqus do not say how much there should be.
        if (extension == ".obj" || extension == ".inp") continue;
        const auto path = folder / std::string("t").append(extension);
        test::write_text(path, text);
        const auto whole = counts(read_mesh_file(path));
        for (std::size_t size = 1; size < text.size(); size += 1 + size / 40) {
            test::write_text(path, text.substr(0, size));
            try {
                EXPECT_EQ(counts(read_mesh_file(path)), whole)
                    << extension << " cut to " << size << " of " << text.size();
            } catch (const Error& error) {
                EXPECT_EQ(exit_code(error.kind()), 3) << error.what();
            }
        }
    }
}

/// The seeds of the fuzz targets, and what they found: by reader, in the order of their names.
std::map<std::string, std::vector<std::filesystem::path>> corpus() {
    std::map<std::string, std::vector<std::filesystem::path>> files;
    const auto folder = test::own_data().parent_path() / "tests/fuzz/corpus";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file() && find_format(entry.path()) != nullptr)
            files[entry.path().parent_path().filename().string()].push_back(entry.path());
    }
    for (auto& [reader, list] : files) std::sort(list.begin(), list.end());
    return files;
}

void read_any(const std::filesystem::path& path) {
    read_mesh_file(path);
}

TEST(FuzzCorpus, IsReadOrRefused) {
    const auto files = corpus();
    EXPECT_GE(files.size(), 12u);
    for (const auto& [reader, list] : files)
        for (const auto& path : list) test::expect_read_or_refused(path, read_any);
}

TEST(DamagedFile, IsReadOrRefusedInLittleTimeAndMemory) {
    const TemporaryFolder folder;
    for (const auto& [reader, list] : corpus()) {
        std::mt19937 random(1);
        for (std::size_t round = 0; round < 200; ++round) {
            const auto& seed = list[round % list.size()];
            const std::string text =
                test::damaged(test::read_text(seed), random, 1 + static_cast<int>(round % 4));
            const auto path = folder / std::string("d").append(seed.extension().string());
            test::write_text(path, text);
            SCOPED_TRACE(reader + ", round " + std::to_string(round));
            test::expect_read_or_refused(path, read_any);
        }
    }
}

}  // namespace
}  // namespace hex::io
