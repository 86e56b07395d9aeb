// The kernel's code for TUMBLE_LANES lanes: included by one source file for each instruction set, inside an unnamed
// namespace, so that no two of them share a symbol. Equations: soft_solver.h.

constexpr float friction_near = float(tuning::friction_near), friction_far_weight = float(tuning::friction_far_weight);
constexpr float slop = float(tuning::soft_slop), push_limit = float(tuning::push_limit), least_give = float(tuning::soft_least_give);

typedef float Lanes __attribute__((vector_size(4 * TUMBLE_LANES)));
typedef float Four __attribute__((vector_size(16)));

struct Vector {
    Lanes x, y, z;
};

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

struct Tensor {   // symmetric
    Lanes xx, xy, xz, yy, yz, zz;
    Vector operator*(const Vector& a) const {
        return {xx * a.x + xy * a.y + xz * a.z, xy * a.x + yy * a.y + yz * a.z, xz * a.x + yz * a.y + zz * a.z};
    }
};

// Four lanes of four floats, transposed within each block of four lanes.
struct Quads {
    Lanes r[4];
};
#if TUMBLE_LANES == 4
inline Lanes low_pairs(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 4, 1, 5); }
inline Lanes high_pairs(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 2, 6, 3, 7); }
inline Lanes low_halves(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5); }
inline Lanes high_halves(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7); }
inline Lanes join(const Four* quad) { return quad[0]; }
inline void part(Lanes a, Four* quad) { quad[0] = a; }
inline Lanes root(Lanes a) { return Lanes(_mm_sqrt_ps(__m128(a))); }
#elif TUMBLE_LANES == 8
inline Lanes low_pairs(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13); }
inline Lanes high_pairs(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15); }
inline Lanes low_halves(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13); }
inline Lanes high_halves(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15); }
inline Lanes join(const Four* quad) { return __builtin_shufflevector(quad[0], quad[1], 0, 1, 2, 3, 4, 5, 6, 7); }
inline void part(Lanes a, Four* quad) {
    quad[0] = __builtin_shufflevector(a, a, 0, 1, 2, 3);
    quad[1] = __builtin_shufflevector(a, a, 4, 5, 6, 7);
}
inline Lanes root(Lanes a) { return Lanes(_mm256_sqrt_ps(__m256(a))); }
#else
inline Lanes low_pairs(Lanes a, Lanes b) { return Lanes(_mm512_unpacklo_ps(__m512(a), __m512(b))); }
inline Lanes high_pairs(Lanes a, Lanes b) { return Lanes(_mm512_unpackhi_ps(__m512(a), __m512(b))); }
inline Lanes low_halves(Lanes a, Lanes b) { return Lanes(_mm512_shuffle_ps(__m512(a), __m512(b), 0x44)); }
inline Lanes high_halves(Lanes a, Lanes b) { return Lanes(_mm512_shuffle_ps(__m512(a), __m512(b), 0xEE)); }
inline Lanes join(const Four* quad) {
    __m512 a = _mm512_castps128_ps512(__m128(quad[0]));
    a = _mm512_insertf32x4(a, __m128(quad[1]), 1);
    a = _mm512_insertf32x4(a, __m128(quad[2]), 2);
    return Lanes(_mm512_insertf32x4(a, __m128(quad[3]), 3));
}
inline void part(Lanes a, Four* quad) {
    quad[0] = Four(_mm512_castps512_ps128(__m512(a)));
    quad[1] = Four(_mm512_extractf32x4_ps(__m512(a), 1));
    quad[2] = Four(_mm512_extractf32x4_ps(__m512(a), 2));
    quad[3] = Four(_mm512_extractf32x4_ps(__m512(a), 3));
}
inline Lanes root(Lanes a) { return Lanes(_mm512_sqrt_ps(__m512(a))); }
#endif

constexpr int blocks = TUMBLE_LANES / 4;

inline Quads transposed(const Quads& q) {
    const Lanes a = low_pairs(q.r[0], q.r[1]), b = high_pairs(q.r[0], q.r[1]);
    const Lanes c = low_pairs(q.r[2], q.r[3]), d = high_pairs(q.r[2], q.r[3]);
    return {{low_halves(a, c), high_halves(a, c), low_halves(b, d), high_halves(b, d)}};
}

// Floats [4 part, 4 part + 4) of each lane's row, one vector a float.
inline Quads gather(const float* base, int stride, const std::uint32_t* lane, int quarter) {
    Quads q;
    for (int i = 0; i < 4; ++i) {
        Four rows[blocks];
        for (int k = 0; k < blocks; ++k)
            rows[k] = *reinterpret_cast<const Four*>(base + std::size_t(lane[4 * k + i] & ~unmoved) * std::size_t(stride) + 4 * quarter);
        q.r[i] = join(rows);
    }
    return transposed(q);
}

inline void scatter(float* base, int stride, const std::uint32_t* lane, int quarter, const Quads& values) {
    const Quads q = transposed(values);
    for (int i = 0; i < 4; ++i) {
        Four rows[blocks];
        part(q.r[i], rows);
        for (int k = 0; k < blocks; ++k)
            if (!(lane[4 * k + i] & unmoved))
                *reinterpret_cast<Four*>(base + std::size_t(lane[4 * k + i]) * std::size_t(stride) + 4 * quarter) = rows[k];
    }
}

struct Motion {
    Vector linear, angular;
};

// half 0: velocities, half 1: displacements.
inline Motion load(const Bodies& bodies, const std::uint32_t* lane, int half) {
    const Quads a = gather(bodies.state, body_floats, lane, 2 * half), b = gather(bodies.state, body_floats, lane, 2 * half + 1);
    return {{a.r[0], a.r[1], a.r[2]}, {a.r[3], b.r[0], b.r[1]}};
}

inline void save(const Bodies& bodies, const std::uint32_t* lane, const Motion& m) {
    scatter(bodies.state, body_floats, lane, 0, {{m.linear.x, m.linear.y, m.linear.z, m.angular.x}});
    scatter(bodies.state, body_floats, lane, 1, {{m.angular.y, m.angular.z, Lanes{}, Lanes{}}});
}

struct Group {
    Lanes* rows;
    const std::uint32_t *a, *b;
    int points;

    Group(const Groups& groups, std::size_t index)
        : rows(reinterpret_cast<Lanes*>(groups.rows) + index * group_rows), a(groups.bodies + 2 * TUMBLE_LANES * index),
          b(a + TUMBLE_LANES), points(groups.points[index]) {}

    Lanes& operator[](int row) const { return rows[row]; }
    Lanes& at(int point, int row) const { return rows[head_rows + point * point_rows + row]; }
    Vector vector(int row) const { return {rows[row], rows[row + 1], rows[row + 2]}; }
    Vector vector(int point, int row) const { return vector(head_rows + point * point_rows + row); }
    void set(int row, const Vector& v) const {
        rows[row] = v.x;
        rows[row + 1] = v.y;
        rows[row + 2] = v.z;
    }
    void set(int point, int row, const Vector& v) const { set(head_rows + point * point_rows + row, v); }
};

inline void apply_normal(const Group& g, int i, Motion& a, Motion& b, Lanes j) {
    const Vector n = g.vector(normal);
    a.linear = a.linear - (j * g[inverse_mass_a]) * n;
    a.angular = a.angular - j * g.vector(i, spin_a);
    b.linear = b.linear + (j * g[inverse_mass_b]) * n;
    b.angular = b.angular + j * g.vector(i, spin_b);
}

inline void apply_friction(const Group& g, Motion& a, Motion& b, Lanes j_1, Lanes j_2, Lanes j_twist) {
    const Vector j = j_1 * g.vector(tangent_1) + j_2 * g.vector(tangent_2);
    a.linear = a.linear - g[inverse_mass_a] * j;
    b.linear = b.linear + g[inverse_mass_b] * j;
    a.angular = a.angular - (j_1 * g.vector(spin_1_a) + j_2 * g.vector(spin_2_a) + j_twist * g.vector(spin_n_a));
    b.angular = b.angular + (j_1 * g.vector(spin_1_b) + j_2 * g.vector(spin_2_b) + j_twist * g.vector(spin_n_b));
}

// Across the normal: the last step's direction, or, where there is none, the axis that the normal looks along least.
inline Vector tangent(const Vector& n, const Vector& last) {
    const Vector kept = last - dot(n, last) * n;
    const Lanes square = dot(kept, kept);
    const auto along_x = n.x * n.x < 0.36f;
    const Vector axis{along_x ? all(1.0f) : Lanes{}, along_x ? Lanes{} : all(1.0f), Lanes{}};
    const Vector other = axis - dot(n, axis) * n;
    const auto keeps = square > 0.25f;
    const Vector t{keeps ? kept.x : other.x, keeps ? kept.y : other.y, keeps ? kept.z : other.z};
    const Lanes length = root(dot(t, t));
    return (1.0f / length) * t;
}

void prepare(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        const Quads mass_a = gather(bodies.mass, mass_floats, g.a, 0), more_a = gather(bodies.mass, mass_floats, g.a, 1);
        const Quads mass_b = gather(bodies.mass, mass_floats, g.b, 0), more_b = gather(bodies.mass, mass_floats, g.b, 1);
        const Tensor inertia_a{mass_a.r[1], mass_a.r[2], mass_a.r[3], more_a.r[0], more_a.r[1], more_a.r[2]};
        const Tensor inertia_b{mass_b.r[1], mass_b.r[2], mass_b.r[3], more_b.r[0], more_b.r[1], more_b.r[2]};
        const Vector n = g.vector(normal), t1 = tangent(n, g.vector(tangent_1)), t2 = cross(n, t1);
        // Lanes without a manifold have no normal: their compliances are made 1, their impulses stay 0.
        const Lanes empty = n.x == 0.0f && n.y == 0.0f && n.z == 0.0f ? all(1.0f) : Lanes{};
        const Lanes both = mass_a.r[0] + mass_b.r[0] + empty;
        g[inverse_mass_a] = mass_a.r[0];
        g[inverse_mass_b] = mass_b.r[0];
        g.set(tangent_1, t1);
        g.set(tangent_2, t2);

        // Friction acts at the centroid of the points that touch or nearly do.
        Vector center{};
        Lanes weights = empty;
        for (int i = 0; i < g.points; ++i) {
            const Lanes weight = g.at(i, normal_mass) * (g.at(i, separation) < friction_near * g[size] ? all(1.0f) : all(friction_far_weight));
            center = center + weight * g.vector(i, arm_a);
            weights += weight;
        }
        const Vector arm_of_a = (1.0f / weights) * center, arm_of_b = arm_of_a + (g.vector(0, arm_b) - g.vector(0, arm_a));
        const Vector a1 = cross(arm_of_a, t1), b1 = cross(arm_of_b, t1), a2 = cross(arm_of_a, t2), b2 = cross(arm_of_b, t2);
        const Vector ia1 = inertia_a * a1, ib1 = inertia_b * b1, ia2 = inertia_a * a2, ib2 = inertia_b * b2;
        const Vector ian = inertia_a * n, ibn = inertia_b * n;
        const Lanes k11 = both + dot(a1, ia1) + dot(b1, ib1), k22 = both + dot(a2, ia2) + dot(b2, ib2);
        const Lanes k12 = dot(a2, ia1) + dot(b2, ib1);
        const Lanes inverse = 1.0f / (k11 * k22 - k12 * k12);
        const Lanes twist_compliance = dot(n, ian) + dot(n, ibn);
        g[stick_mass] = k22 * inverse;
        g[stick_mass + 1] = -k12 * inverse;
        g[stick_mass + 2] = k11 * inverse;
        g[slide_mass] = 2.0f / (k11 + k22 + root((k11 - k22) * (k11 - k22) + 4.0f * k12 * k12));
        g[twist_mass] = 1.0f / (twist_compliance + empty);
        g.set(turn_1_a, a1);
        g.set(turn_1_b, b1);
        g.set(turn_2_a, a2);
        g.set(turn_2_b, b2);
        g.set(spin_1_a, ia1);
        g.set(spin_1_b, ib1);
        g.set(spin_2_a, ia2);
        g.set(spin_2_b, ib2);
        g.set(spin_n_a, ian);
        g.set(spin_n_b, ibn);
        for (int i = 0; i < g.points; ++i) {
            const Vector away = g.vector(i, arm_a) - arm_of_a;
            g.at(i, lever) = root(dot(away, away));
            const Vector an = cross(g.vector(i, arm_a), n), bn = cross(g.vector(i, arm_b), n);
            const Vector ian_i = inertia_a * an, ibn_i = inertia_b * bn;
            g.set(i, arm_a, an);
            g.set(i, arm_b, bn);
            g.set(i, spin_a, ian_i);
            g.set(i, spin_b, ibn_i);
            g.at(i, normal_mass) = g.at(i, normal_mass) / (both + dot(an, ian_i) + dot(bn, ibn_i));
        }
    }
}

void warm_start(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
        for (int i = 0; i < g.points; ++i) apply_normal(g, i, a, b, g.at(i, impulse));
        apply_friction(g, a, b, g[friction_1], g[friction_2], g[twist]);
        save(bodies, g.a, a);
        save(bodies, g.b, b);
    }
}

void accelerate(std::size_t first, std::size_t last, const Bodies& bodies, bool again) {
    for (std::size_t s = first; s < last; ++s) {
        Four* v = reinterpret_cast<Four*>(bodies.state + body_floats * s);
        const Four* force = reinterpret_cast<const Four*>(bodies.forces + 8 * s);
        Four* start = reinterpret_cast<Four*>(bodies.start + 8 * s);
        for (int k = 0; k < 2; ++k) {
            const Four contact = again ? v[k] - start[k] : Four{};
            start[k] = v[k] + force[k];
            v[k] = start[k] + contact;
        }
    }
}

void move(std::size_t first, std::size_t last, const Bodies& bodies, float substep) {
    for (std::size_t s = first; s < last; ++s) {
        Four* v = reinterpret_cast<Four*>(bodies.state + body_floats * s);
        v[2] += substep * v[0];
        v[3] += substep * v[1];
    }
}

// Coulomb's disc about where friction acts, and a twist about the normal, both within what the normal impulses allow now.
inline void solve_friction(const Group& g, Motion& a, Motion& b) {
    Lanes load_all = Lanes{}, load_levers = Lanes{};
    for (int i = 0; i < g.points; ++i) {
        load_all += g.at(i, impulse);
        load_levers += g.at(i, impulse) * g.at(i, lever);
    }
    const Lanes limit = g[friction_coefficient] * load_all, twist_limit = g[friction_coefficient] * load_levers;
    const Vector slip = b.linear - a.linear;
    const Lanes v1 = dot(slip, g.vector(tangent_1)) + dot(b.angular, g.vector(turn_1_b)) - dot(a.angular, g.vector(turn_1_a));
    const Lanes v2 = dot(slip, g.vector(tangent_2)) + dot(b.angular, g.vector(turn_2_b)) - dot(a.angular, g.vector(turn_2_a));
    const Lanes turning = dot(g.vector(normal), b.angular - a.angular);
    // What stops the slip altogether, if the disc allows it. Else one mass for both directions: friction then ends up
    // against the slip, from where each direction's own mass would turn it aside.
    const Lanes stick_1 = g[friction_1] - (g[stick_mass] * v1 + g[stick_mass + 1] * v2);
    const Lanes stick_2 = g[friction_2] - (g[stick_mass + 1] * v1 + g[stick_mass + 2] * v2);
    const Lanes slide_1 = g[friction_1] - g[slide_mass] * v1, slide_2 = g[friction_2] - g[slide_mass] * v2;
    const Lanes size = root(slide_1 * slide_1 + slide_2 * slide_2);
    const Lanes scale = size > limit ? limit / size : all(1.0f);
    const auto sticks = stick_1 * stick_1 + stick_2 * stick_2 <= limit * limit;
    const Lanes j1 = sticks ? stick_1 : scale * slide_1, j2 = sticks ? stick_2 : scale * slide_2;
    const Lanes j3 = larger(-twist_limit, smaller(twist_limit, g[twist] - g[twist_mass] * turning));
    apply_friction(g, a, b, j1 - g[friction_1], j2 - g[friction_2], j3 - g[twist]);
    g[friction_1] = j1;
    g[friction_2] = j2;
    g[twist] = j3;
}

template <bool pushing>
inline void sweep(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies, float substeps_per_second) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        Motion a = load(bodies, g.a, 0), b = load(bodies, g.b, 0);
        const Motion moved_a = load(bodies, g.a, 1), moved_b = load(bodies, g.b, 1);
        if constexpr (pushing) solve_friction(g, a, b);
        const Lanes parted = dot(moved_b.linear - moved_a.linear, g.vector(normal));
        for (int i = 0; i < g.points; ++i) {
            const Vector an = g.vector(i, arm_a), bn = g.vector(i, arm_b);
            const Lanes gap = g.at(i, separation) + parted + dot(moved_b.angular, bn) - dot(moved_a.angular, an);
            const Lanes speed = dot(b.linear - a.linear, g.vector(normal)) + dot(b.angular, bn) - dot(a.angular, an);
            const Lanes closing = gap * substeps_per_second, old = g.at(i, impulse);
            Lanes next;
            if constexpr (pushing) {
                // Deeper than the limit the spring pushes no faster, but between bodies that move carries some more all the same.
                const Lanes spring = g[bias_rate] * smaller(gap + slop * g[size], Lanes{}), most = -push_limit * g[size];
                const auto apart = gap > 0.0f, limited = spring < most && g[inverse_mass_a] > 0.0f && g[inverse_mass_b] > 0.0f;
                const Lanes bias = apart ? closing : larger(spring, most);
                const Lanes give = limited ? g[impulse_scale] * larger(most / spring, all(least_give)) : g[impulse_scale];
                const Lanes mass = apart ? all(1.0f) : g[mass_scale], keep = apart ? Lanes{} : give;
                next = old - g.at(i, normal_mass) * mass * (speed + bias) - keep * old;
            } else {
                const Lanes bias = larger(closing, Lanes{});
                next = old - g.at(i, normal_mass) * (speed + bias);
            }
            next = larger(next, Lanes{});
            g.at(i, impulse) = next;
            apply_normal(g, i, a, b, next - old);
        }
        if constexpr (!pushing) {
            // Last, so that it holds what the normal impulses now allow.
            solve_friction(g, a, b);
            for (int i = 0; i < g.points; ++i) g.at(i, impulse_sum) += g.at(i, impulse);
            g[friction_1_sum] += g[friction_1];
            g[friction_2_sum] += g[friction_2];
            g[twist_sum] += g[twist];
        }
        save(bodies, g.a, a);
        save(bodies, g.b, b);
    }
}

void push(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies, float substeps_per_second) {
    sweep<true>(groups, first, last, bodies, substeps_per_second);
}
void relax(const Groups& groups, std::size_t first, std::size_t last, const Bodies& bodies, float substeps_per_second) {
    sweep<false>(groups, first, last, bodies, substeps_per_second);
}

void sum(const Groups& groups, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
        const Group g(groups, k);
        const Lanes j1 = g[friction_1_sum], j2 = g[friction_2_sum];
        Lanes along_normal{};
        Vector turning = g[twist_sum] * g.vector(normal) + j1 * g.vector(turn_1_a) + j2 * g.vector(turn_2_a);
        for (int i = 0; i < g.points; ++i) {
            along_normal += g.at(i, impulse_sum);
            turning = turning + g.at(i, impulse_sum) * g.vector(i, arm_a);
        }
        g.set(force, along_normal * g.vector(normal) + j1 * g.vector(tangent_1) + j2 * g.vector(tangent_2));
        g.set(moment, turning);
    }
}
