// Functions compiled once more for AVX2, chosen at the program's start: more lanes where the processor has them, with the
// same bits, since nothing is fused. Sanitizers do without: they cannot look into the choosing.
#pragma once

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TUMBLE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define TUMBLE_WIDE
#endif
