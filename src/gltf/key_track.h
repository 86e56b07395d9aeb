// Keys of one animated quantity, a position or a rotation. For glTF's CUBICSPLINE interpolation: as few as describe all
// samples of the motion within a tolerance. For LINEAR: one for each sample, except in rest.
//
// A segment between two keys grows sample by sample as long as its cubic passes all samples within the tolerance. Its
// tangents are the given velocities: exact for parabolas. If these do not fit, because a stepped motion's velocities
// belong to another moment than its positions, they are differences of the samples.
#pragma once

#include "core/vector.h"

#include <optional>
#include <utility>
#include <vector>

namespace tumble {

/// A sample of the motion. `N`: 3, a position in m; 4, a unit quaternion (x, y, z, w), on the half of its predecessor.
template <int N>
struct KeySample {
    using Value = Eigen::Matrix<double, N, 1>;
    double time = 0.0;  // s
    Value value = Value::Zero();
    Value in = Value::Zero(), out = Value::Zero();  // derivatives by time before and after it
    bool corner = false;                            // becomes a key, with both derivatives
};

/// glTF's interpolation between keys: CUBICSPLINE or LINEAR.
enum class KeyKind { cubic, linear };

template <int N>
class KeyTrack {
public:
    using Value = Eigen::Matrix<double, N, 1>;
    /// A key as the file has it; derivatives are per s.
    struct Key {
        float time;
        Eigen::Matrix<float, N, 1> in, value, out;

        static Key of(double time, const Value& value) {
            using Floats = Eigen::Matrix<float, N, 1>;
            return {float(time), Floats::Zero(), value.template cast<float>(), Floats::Zero()};
        }
    };

    /// `tolerance`: of cubic keys, m or rad. `velocities`: whether the samples have derivatives.
    KeyTrack(KeyKind kind, double tolerance, bool velocities)
        : kind_(kind), tolerance_(tolerance), velocities_(velocities) {}

    /// Times must increase in single precision.
    void add(const KeySample<N>& sample);
    /// Closes the last segment. Keys of a value that no longer changes are left out; a single key means no motion.
    void finish();

    KeyKind kind() const { return kind_; }
    /// Linear keys have no derivatives.
    const std::vector<Key>& keys() const { return keys_; }
    /// Largest deviation of the keys, in single precision, from the samples, m or rad.
    double error() const { return error_; }

private:
    using Tangents = std::pair<Value, Value>;  // at the start and the end of the segment

    void add_linear(const KeySample<N>& sample);
    bool ends_equal() const;
    std::optional<Tangents> fit();
    bool fits(const Tangents& tangents) const;
    bool continues(const Tangents& tangents) const;
    bool passes(const Tangents& tangents, const KeySample<N>& sample, double tolerance) const;
    Tangents differences() const;
    void close();
    void measure();

    KeyKind kind_;
    double tolerance_;
    bool velocities_;
    bool started_ = false;
    bool still_ = false;       // all samples of the segment have the value of its start
    bool steady_ = false;      // the segment is one cubic, as in free flight
    bool ends_still_ = false;  // the last closed segment was still
    KeySample<N> start_;
    std::vector<KeySample<N>> samples_;  // of the segment, after its start
    Tangents tangents_{Value::Zero(), Value::Zero()};
    std::vector<Key> keys_;
    double error_ = 0.0;
};

extern template class KeyTrack<3>;
extern template class KeyTrack<4>;

}  // namespace tumble
