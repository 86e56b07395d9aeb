#include "joints/watches.h"

#include <algorithm>

namespace tumble::bench {
namespace {

// Keeps the largest value, and a value that is not a number.
void raise(double& most, double value) {
    if (!(value <= most)) most = value;
}

class EndWatch : public Watch {
public:
    EndWatch(const Scene& scene, double seconds, std::optional<EndError> end, double scale)
        : scene_(scene), seconds_(seconds), end_(std::move(end)), scale_(scale) {}

    void see(double time, const Simulator& simulator, const std::vector<Motion>& motions) override {
        if (time == 0.0) start_ = energy(scene_, motions);
        raise(gap_, largest_gap(scene_, motions));
        if (scale_ > 0.0) raise(energy_, std::fabs(energy(scene_, motions) - start_) / scale_);
        if (end_ && time > seconds_ * (1.0 - 1e-9)) error_ = end_->measure(simulator, motions);
    }
    std::vector<Quantity> tell() const override {
        std::vector<Quantity> all;
        if (end_) all.push_back({"error", error_, end_->unit});
        all.push_back({"gap", gap_, "m"});
        if (scale_ > 0.0) all.push_back({"energy", energy_, ""});
        return all;
    }

private:
    Scene scene_;
    double seconds_;
    std::optional<EndError> end_;
    double scale_, start_ = 0.0, gap_ = 0.0, energy_ = 0.0, error_ = HUGE_VAL;
};

class MomentumWatch : public Watch {
public:
    explicit MomentumWatch(const Scene& scene) : scene_(scene) {}

    void see(double time, const Simulator&, const std::vector<Motion>& motions) override {
        Vector p, l;
        double sum_p = 0.0, sum_l = 0.0;
        for (std::size_t i = 0; i < motions.size(); ++i) {
            const Body& body = scene_.bodies[i];
            if (!body.moves()) continue;
            const Vector own = body.mass * motions[i].velocity;
            const Vector turning = cross(motions[i].position, own) + angular_momentum(body, motions[i]);
            p = p + own;
            l = l + turning;
            sum_p += norm(own);
            sum_l += norm(turning);
        }
        const double now = energy(scene_, motions);
        if (time == 0.0) {
            p_ = p;
            l_ = l;
            sum_p_ = sum_p;
            sum_l_ = sum_l;
            start_ = now;
        }
        raise(momentum_, norm(p - p_) / sum_p_);
        raise(angular_, norm(l - l_) / sum_l_);
        raise(energy_, std::fabs(now - start_) / start_);
        raise(gap_, largest_gap(scene_, motions));
    }
    std::vector<Quantity> tell() const override {
        return {{"energy", energy_, ""},
                {"momentum", momentum_, ""},
                {"angular momentum", angular_, ""},
                {"gap", gap_, "m"}};
    }

private:
    Scene scene_;
    Vector p_, l_;
    double start_ = 0.0, sum_p_ = 0.0, sum_l_ = 0.0, momentum_ = 0.0, angular_ = 0.0, energy_ = 0.0, gap_ = 0.0;
};

class CalmWatch : public Watch {
public:
    explicit CalmWatch(const Scene& scene) : scene_(scene) {}

    void see(double, const Simulator&, const std::vector<Motion>& motions) override {
        raise(gap_, largest_gap(scene_, motions));
        raise(beyond_, largest_excess(scene_, motions));
        fastest_ = 0.0;
        for (std::size_t i = 0; i < motions.size(); ++i)
            if (scene_.bodies[i].moves()) raise(fastest_, norm(motions[i].velocity));
    }
    std::vector<Quantity> tell() const override {
        return {{"gap", gap_, "m"}, {"beyond a limit", beyond_, "rad"}, {"fastest body", fastest_, "m/s"}};
    }

private:
    Scene scene_;
    double gap_ = 0.0, beyond_ = 0.0, fastest_ = 0.0;
};

}  // namespace

std::function<std::unique_ptr<Watch>(const Scene&, double)> watch_end(const std::optional<EndError>& end,
                                                                      double energy_scale) {
    return [=](const Scene& scene, double seconds) {
        return std::make_unique<EndWatch>(scene, seconds, end, energy_scale);
    };
}

std::function<std::unique_ptr<Watch>(const Scene&, double)> watch_momentum() {
    return [](const Scene& scene, double) { return std::make_unique<MomentumWatch>(scene); };
}

std::function<std::unique_ptr<Watch>(const Scene&, double)> watch_calm() {
    return [](const Scene& scene, double) { return std::make_unique<CalmWatch>(scene); };
}

double angle_about(const Vector& axis, const Vector& from, const Vector& to) {
    return std::atan2(dot(axis, cross(from, to)), dot(from, to));
}

Vector carried(const Body& body, const Motion& motion, const Vector& direction) {
    return rotate(motion.orientation, rotate_back(body.orientation, direction));
}

}  // namespace tumble::bench
