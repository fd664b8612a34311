#include <hex/base/registry.h>

namespace hex {

std::string& registration_origin() {
    static std::string origin = "built-in";
    return origin;
}

}  // namespace hex
