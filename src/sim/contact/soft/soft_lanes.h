// Vectors of TUMBLE_LANES floats, and the transposition of rows in memory into them: part of soft_kernel_lanes.h, which
// says how it is included.

typedef float Lanes __attribute__((vector_size(4 * TUMBLE_LANES)));
typedef float Eight __attribute__((vector_size(32)));  // a body's velocities, or its displacements

using Vector = Vector3<Lanes>;
using Tensor = Symmetric3<Lanes>;

inline Lanes all(float value) { return value - Lanes{}; }
inline Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(Lanes s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Lanes dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Vector operator*(const Tensor& t, const Vector& a) {
    return {t.xx * a.x + t.xy * a.y + t.xz * a.z, t.xy * a.x + t.yy * a.y + t.yz * a.z,
            t.xz * a.x + t.yz * a.y + t.zz * a.z};
}

// Four floats per lane: lane after lane in memory, transposed in registers.
struct Quads {
    Lanes r[4];
};
// Eight floats per lane, one vector per float.
struct Eights {
    Quads low, high;
};
#if TUMBLE_LANES == 4
inline Lanes low_pairs(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 4, 1, 5); }
inline Lanes high_pairs(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 2, 6, 3, 7); }
inline Lanes low_halves(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5); }
inline Lanes high_halves(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7); }
#ifdef __SSE__
inline Lanes root(Lanes a) { return Lanes(_mm_sqrt_ps(__m128(a))); }
inline bool any(Lanes a) { return _mm_movemask_ps(_mm_cmpneq_ps(__m128(a), _mm_setzero_ps())) != 0; }
#else  // a processor without vectors: the compiler takes each operation apart
inline Lanes root(Lanes a) { return {std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])}; }
inline bool any(Lanes a) { return a[0] != 0.0f || a[1] != 0.0f || a[2] != 0.0f || a[3] != 0.0f; }
#endif
template <class Row>
inline Eights read(Row&& row) {
    Eights e;
    for (int i = 0; i < 4; ++i) {
        e.low.r[i] = *reinterpret_cast<const Lanes*>(row(i));
        e.high.r[i] = *reinterpret_cast<const Lanes*>(row(i) + 4);
    }
    return e;
}
template <class Row>
inline void write(const Eights& e, Row&& row) {
    for (int i = 0; i < 4; ++i)
        if (float* to = row(i)) {
            *reinterpret_cast<Lanes*>(to) = e.low.r[i];
            *reinterpret_cast<Lanes*>(to + 4) = e.high.r[i];
        }
}
#elif TUMBLE_LANES == 8
inline Lanes low_pairs(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13); }
inline Lanes high_pairs(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15); }
inline Lanes low_halves(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13); }
inline Lanes high_halves(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15); }
inline Lanes root(Lanes a) { return Lanes(_mm256_sqrt_ps(__m256(a))); }
inline bool any(Lanes a) { return _mm256_movemask_ps(_mm256_cmp_ps(__m256(a), _mm256_setzero_ps(), _CMP_NEQ_UQ)) != 0; }
inline Lanes joined(Lanes a, Lanes b, bool high) {
    return Lanes(high ? _mm256_permute2f128_ps(__m256(a), __m256(b), 0x31)
                      : _mm256_permute2f128_ps(__m256(a), __m256(b), 0x20));
}
template <class Row>
inline Eights read(Row&& row) {
    Eights e;
    for (int i = 0; i < 4; ++i) {
        const Lanes a = *reinterpret_cast<const Lanes*>(row(i)), b = *reinterpret_cast<const Lanes*>(row(4 + i));
        e.low.r[i] = joined(a, b, false);
        e.high.r[i] = joined(a, b, true);
    }
    return e;
}
template <class Row>
inline void write(const Eights& e, Row&& row) {
    for (int i = 0; i < 4; ++i)
        for (const bool second : {false, true})
            if (float* to = row(second ? 4 + i : i))
                *reinterpret_cast<Lanes*>(to) = joined(e.low.r[i], e.high.r[i], second);
}
#else
inline Lanes low_pairs(Lanes a, Lanes b) { return Lanes(_mm512_unpacklo_ps(__m512(a), __m512(b))); }
inline Lanes high_pairs(Lanes a, Lanes b) { return Lanes(_mm512_unpackhi_ps(__m512(a), __m512(b))); }
inline Lanes low_halves(Lanes a, Lanes b) { return Lanes(_mm512_shuffle_ps(__m512(a), __m512(b), 0x44)); }
inline Lanes high_halves(Lanes a, Lanes b) { return Lanes(_mm512_shuffle_ps(__m512(a), __m512(b), 0xEE)); }
inline Lanes root(Lanes a) { return Lanes(_mm512_sqrt_ps(__m512(a))); }
inline bool any(Lanes a) { return _mm512_cmp_ps_mask(__m512(a), _mm512_setzero_ps(), _CMP_NEQ_UQ) != 0; }
inline __m512 two_rows(const float* a, const float* b) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_load_ps(a)), _mm256_load_ps(b), 1);
}
template <class Row>
inline Eights read(Row&& row) {
    Eights e;
    for (int i = 0; i < 4; ++i) {
        const __m512 x = two_rows(row(i), row(4 + i)), y = two_rows(row(8 + i), row(12 + i));
        e.low.r[i] = Lanes(_mm512_shuffle_f32x4(x, y, 0x88));
        e.high.r[i] = Lanes(_mm512_shuffle_f32x4(x, y, 0xDD));
    }
    return e;
}
template <class Row>
inline void write(const Eights& e, Row&& row) {
    const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11),
                  second = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    for (int i = 0; i < 4; ++i)
        for (const int half : {0, 8}) {
            const __m512 rows = _mm512_castpd_ps(_mm512_permutex2var_pd(
                _mm512_castps_pd(__m512(e.low.r[i])), half ? second : first, _mm512_castps_pd(__m512(e.high.r[i]))));
            if (float* to = row(half + i)) _mm256_store_ps(to, _mm512_castps512_ps256(rows));
            if (float* to = row(half + 4 + i)) _mm256_store_ps(to, _mm512_extractf32x8_ps(rows, 1));
        }
}
#endif

inline Quads transposed(const Quads& q) {
    const Lanes a = low_pairs(q.r[0], q.r[1]), b = high_pairs(q.r[0], q.r[1]);
    const Lanes c = low_pairs(q.r[2], q.r[3]), d = high_pairs(q.r[2], q.r[3]);
    return {{low_halves(a, c), high_halves(a, c), low_halves(b, d), high_halves(b, d)}};
}

template <class Row>
inline Eights gather(Row&& row) {
    const Eights e = read(row);
    return {transposed(e.low), transposed(e.high)};
}
