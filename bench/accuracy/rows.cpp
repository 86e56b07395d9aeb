// A ball that runs into touching balls, e = 1, no gravity: each law has a closed-form result.
#include "accuracy/accuracy_case.h"

#include <algorithm>

namespace tumble::bench {
namespace {

class OutcomeObserver : public Observer {
public:
    OutcomeObserver(std::vector<Vector> outcome, double seconds) : outcome_(std::move(outcome)), seconds_(seconds) {}
    void see(long step, double rate, const std::vector<Motion>& motions) override {
        if (step != std::lround(seconds_ * rate)) return;
        for (std::size_t i = 0; i < outcome_.size(); ++i)
            error_ = std::max(error_, norm(motions[i].velocity - outcome_[i]));
    }
    std::vector<Error> errors() const override { return {{"velocity", error_, "m/s"}}; }

private:
    std::vector<Vector> outcome_;
    double seconds_, error_ = 0.0;
};

AccuracyCase row(const std::string& name, Demand demand, const std::vector<Vector>& places,
                 const std::vector<Vector>& outcome) {
    AccuracyCase c;
    c.name = name;
    c.demand = demand;
    c.scene.gravity = 0.0;
    for (const Vector& place : places) {
        Body ball;
        ball.radius = 0.5;
        ball.position = place;
        if (&place == &places.front()) ball.velocity = {1.0, 0.0, 0.0};
        c.scene.bodies.push_back(ball);
    }
    c.seconds = c.quick_seconds = 2.0;
    c.rates = {60.0, 240.0, 960.0};
    c.quick_rates = {60.0};
    c.observe = [outcome](const Scene&, double seconds) { return std::make_unique<OutcomeObserver>(outcome, seconds); };
    return c;
}

}  // namespace

void add_rows(std::vector<AccuracyCase>& cases) {
    for (const int n : {3, 5}) {
        std::vector<Vector> places{{-1.37, 0.0, 0.0}}, handed_on(std::size_t(n), Vector{}),
            newton(std::size_t(n), Vector{2.0 / n, 0.0, 0.0});
        for (int i = 1; i < n; ++i) places.push_back({double(i), 0.0, 0.0});
        // Propagating: only the last one leaves. Newton's law for all contacts at once: those in front leave together
        // with v, no contact opens among them, so m (1 - (n-1) v) remains for the first, and v - v_first = 1: v = 2/n.
        handed_on.back() = {1.0, 0.0, 0.0};
        newton.front() = {2.0 / n - 1.0, 0.0, 0.0};
        const std::string name = "cradle of " + std::to_string(n);
        cases.push_back(row(name, Demand::row_propagating, places, handed_on));
        cases.push_back(row(name + ", simultaneous", Demand::row_simultaneous, places, newton));
    }
    // Bernoulli 1742: the first rebounds at a fifth, the two leave at 30 degrees with 2 sqrt(3) / 5, for both laws: the
    // two impulses are equal. j = 2 c v / (1 + 2 c^2), c = cos 30; the first keeps v - 2 c j.
    const double c = 0.5 * std::sqrt(3.0), j = 2.0 * c / (1.0 + 2.0 * c * c);
    const std::vector<Vector> places{{-1.37, 0.0, 0.0}, {c, 0.5, 0.0}, {c, -0.5, 0.0}};
    const std::vector<Vector> outcome{{1.0 - 2.0 * c * j, 0.0, 0.0}, {c * j, 0.5 * j, 0.0}, {c * j, -0.5 * j, 0.0}};
    cases.push_back(row("Bernoulli's three balls", Demand::row_propagating, places, outcome));
    cases.push_back(row("Bernoulli's three balls, simultaneous", Demand::row_simultaneous, places, outcome));
}

}  // namespace tumble::bench
