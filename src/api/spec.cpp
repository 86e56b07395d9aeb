#include "tumble/spec.h"

#include "api/guard.h"
#include "api/spec_text.h"

namespace tumble::v0 {

std::string to_toml(const SceneSpec& spec) {
    return guarded([&] { return spec_text(spec); });
}

}  // namespace tumble::v0
