#include "tumble/version.h"

namespace tumble::v0 {

const char* version() { return TUMBLE_VERSION; }

}  // namespace tumble::v0
