#include "segment/chart_order.h"

#include <algorithm>
#include <cstddef>

namespace hex {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

}  // namespace

const std::vector<ChartOrder::Arc>& ChartOrder::conflicts() {
    // Charts that nothing comes before, or nothing after, are in no cycle: they are peeled off.
    int charts = 0;
    for (const Arc& arc : arcs_) charts = std::max({charts, arc.before + 1, arc.after + 1});
    for (bool peeled = true; peeled;) {
        incoming_.assign(at(charts), 0);
        outgoing_.assign(at(charts), 0);
        for (const Arc& arc : arcs_) {
            ++outgoing_[at(arc.before)];
            ++incoming_[at(arc.after)];
        }
        peeled = std::erase_if(arcs_, [&](const Arc& arc) {
                     return arc.before != arc.after &&
                            (incoming_[at(arc.before)] == 0 || outgoing_[at(arc.after)] == 0);
                 }) > 0;
    }
    disorder_ = 0;
    for (const Arc& arc : arcs_) disorder_ += arc.before == arc.after ? 2 : 0;
    for (int c = 0; c < charts; ++c) disorder_ += incoming_[at(c)] > 0 && outgoing_[at(c)] > 0 ? 1 : 0;
    return arcs_;
}

}  // namespace hex
