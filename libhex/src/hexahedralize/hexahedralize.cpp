#include "hexahedralize/search.h"

#include <hex/hexahedralize/hexahedralize.h>

#include <utility>

namespace hex {

const char* name_of(HexStage stage) {
    switch (stage) {
        case HexStage::segment:
            return "segment";
        case HexStage::polycube:
            return "polycube";
        case HexStage::map:
            return "map";
        case HexStage::improve:
            return "improve";
    }
    return "";
}

HexahedralizeResult hexahedralize(HexModel start, HexStage first, HexStage last,
                                  const HexahedralizeOptions& options, const Context& context) {
    return Search(std::move(start), options, context).run(first, last);
}

HexahedralizeResult hexahedralize(const TriangleMesh& surface, const HexahedralizeOptions& options,
                                  const Context& context) {
    HexModel start;
    start.surface = surface;
    return hexahedralize(std::move(start), HexStage::segment, HexStage::improve, options, context);
}

}  // namespace hex
