#include "contact/witness.h"

#include "harness/penetration.h"

#include <algorithm>

namespace tumble::bench {
namespace {

class Overlap : public Witness {
public:
    explicit Overlap(const Scene& scene) : scene_(scene) {}

    void see(double, const std::vector<Motion>& motions) override { last_ = motions; }

    std::vector<Quantity> tell() const override {
        const Penetration p = penetration(scene_, last_);
        double speed = 0.0;
        long lost = 0;
        for (std::size_t i = 0; i < last_.size(); ++i) {
            if (!scene_.bodies[i].moves()) continue;
            if (!finite(last_[i]) || last_[i].position.z < 0.0)
                ++lost;
            else
                speed = std::max(speed, norm(last_[i].velocity));
        }
        return {{"mean penetration", 1e3 * p.mean, "mm"},
                {"largest penetration", 1e3 * p.largest, "mm"},
                {"fastest body", speed, "m/s"},
                {"lost", double(lost), "bodies"}};
    }

private:
    Scene scene_;
    std::vector<Motion> last_;
};

class Standing : public Witness {
public:
    Standing(const Scene& scene, double fallen) : scene_(scene), fallen_(fallen) {}

    void see(double time, const std::vector<Motion>& motions) override {
        for (std::size_t i = 0; i < motions.size(); ++i) {
            const Body& body = scene_.bodies[i];
            if (!body.moves()) continue;
            const Vector way = motions[i].position - body.position;
            const double sideways = std::hypot(way.x, way.y);
            drift_ = std::max(drift_, finite(motions[i]) ? sideways : HUGE_VAL);
            sunk_ = std::max(sunk_, finite(motions[i]) ? -way.z : HUGE_VAL);
        }
        overlap_ = std::max(overlap_, penetration(scene_, motions).largest);
        if (time_ < 0.0 && std::max(drift_, sunk_) > fallen_) time_ = time;
    }

    std::vector<Quantity> tell() const override {
        std::vector<Quantity> all{{"drift", drift_, "m"}, {"sinking", sunk_, "m"}, {"penetration", overlap_, "m"}};
        if (time_ >= 0.0) all.push_back({"fell at", time_, "s"});
        return all;
    }

private:
    Scene scene_;
    double fallen_, drift_ = 0.0, sunk_ = 0.0, overlap_ = 0.0, time_ = -1.0;
};

}  // namespace

std::unique_ptr<Witness> witness_of_overlap(const Scene& scene) { return std::make_unique<Overlap>(scene); }

std::unique_ptr<Witness> witness_of_standing(const Scene& scene, double fallen) {
    return std::make_unique<Standing>(scene, fallen);
}

}  // namespace tumble::bench
