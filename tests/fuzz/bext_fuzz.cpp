// BEXT 1 and, by its first line, BEXT 2.0.
#include "fuzz_reader.h"
#include "memory_file.h"

#include <spline/io/bext.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const hex::io::MemoryFile file(bytes, size);
    try {
        const spline::BezierSpline result = spline::io::read_bext(file.path());
        hex::io::require(result.element_count() > 0);
    } catch (const hex::Error& error) {
        hex::io::require(hex::exit_code(error.kind()) == 3);
    }
    return 0;
}
