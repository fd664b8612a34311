#include <hex/base/error.h>
#include <hex/hexahedralize/hex_model.h>

namespace hex {

const char* name_of(Route route) {
    switch (route) {
        case Route::given:
            return "given";
        case Route::labelling:
            return "labelling";
        case Route::voxel:
            return "voxel";
    }
    return "";
}

const TriangleMesh& HexModel::mapped_surface() const {
    if (route == Route::voxel) return surface;
    if (!patches) throw Error(ErrorKind::usage, "the model has no patches");
    return *patches;
}

}  // namespace hex
