// Functions compiled a second time for AVX2 and selected at program start: more lanes with the same bits, because no
// operations are fused. Disabled with sanitizers, which do not support the selection, and with clang, which gives the
// functions other names.
#pragma once

#if defined(__x86_64__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TUMBLE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define TUMBLE_WIDE
#endif
