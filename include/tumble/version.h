// The version of the library, and the namespace of its interface.
#pragma once

#define TUMBLE_VERSION_MAJOR 0
#define TUMBLE_VERSION_MINOR 1
#define TUMBLE_VERSION_PATCH 0

// The interface lives in tumble::v0, an inline namespace: a program writes tumble::World. The sources of the library
// have a tumble::World of their own, so for them the namespace is not inline. The linker names are the same.
#ifdef TUMBLE_BUILDS_LIBRARY
#define TUMBLE_BEGIN   \
    namespace tumble { \
    namespace v0 {
#else
#define TUMBLE_BEGIN   \
    namespace tumble { \
    inline namespace v0 {
#endif
#define TUMBLE_END \
    }              \
    }

TUMBLE_BEGIN

/// The version of the installed library, "0.1.0".
const char* version();

TUMBLE_END
