// The small text files of the paper. The first byte says which.
#include "fuzz_reader.h"
#include "memory_file.h"

#include <hex/io/list_file.h>

#include <algorithm>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    if (size == 0) return 0;
    const hex::io::MemoryFile file(bytes + 1, size - 1);
    try {
        switch (bytes[0]) {
            case 'L':
                hex::io::read_labels(file.path());
                break;
            case 'O':
                for (const auto& change : hex::io::read_overrides(file.path()))
                    hex::io::require(change.line > 0);
                break;
            case 'S':
                hex::io::read_sharp_vertices(file.path());
                break;
            default:
                for (const auto& level : hex::io::read_refinement(file.path()))
                    hex::io::require(std::all_of(level.begin(), level.end(), [](auto e) { return e >= 0; }));
        }
    } catch (const hex::Error& error) {
        hex::io::require(hex::exit_code(error.kind()) == 3);
    }
    return 0;
}
