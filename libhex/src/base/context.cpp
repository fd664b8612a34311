#include <hex/base/context.h>
#include <hex/base/error.h>

namespace hex {

void Context::check_cancelled() const {
    if (stop.stop_requested()) throw Error(ErrorKind::cancelled, "interrupted");
}

}  // namespace hex
