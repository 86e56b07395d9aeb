// The values of samples: distributions, independence of other samples and axes, pairs and names.
#include "app/sweep/sweep_sample.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tumble::sweep_sample_test {
namespace {

constexpr int draws = 20000;

SweepAxis axis_of(const std::string& name, Distribution distribution) {
    return {name, {"body." + name}, std::move(distribution), std::nullopt};
}

Distribution uniform(double min, double max) {
    Distribution d;
    d.min = {min};
    d.max = {max};
    return d;
}

std::vector<double> numbers(const Distribution& distribution, std::uint64_t seed = 1) {
    std::vector<double> values;
    for (int i = 0; i < draws; ++i) {
        DrawStream stream(seed, "x", std::uint64_t(i));
        values.push_back(std::stod(draw_value(distribution, stream)));
    }
    return values;
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / double(values.size());
}

double deviation(const std::vector<double>& values) {
    const double middle = mean(values);
    double sum = 0.0;
    for (const double value : values) sum += (value - middle) * (value - middle);
    return std::sqrt(sum / double(values.size()));
}

// The bounds are five standard errors of the estimates, and the streams are fixed.
TEST(Distributions, Uniform) {
    const std::vector<double> values = numbers(uniform(2.0, 5.0));
    EXPECT_NEAR(mean(values), 3.5, 5.0 * 3.0 / std::sqrt(12.0 * draws));
    EXPECT_NEAR(deviation(values), 3.0 / std::sqrt(12.0), 0.02);
    for (const double value : values) EXPECT_TRUE(value >= 2.0 && value <= 5.0) << value;
}

TEST(Distributions, LogUniform) {
    Distribution d = uniform(0.01, 100.0);
    d.kind = DistributionKind::log_uniform;
    std::vector<double> logs;
    for (const double value : numbers(d)) {
        EXPECT_TRUE(value >= 0.01 && value <= 100.0) << value;
        logs.push_back(std::log10(value));
    }
    EXPECT_NEAR(mean(logs), 0.0, 5.0 * 4.0 / std::sqrt(12.0 * draws));
    EXPECT_NEAR(deviation(logs), 4.0 / std::sqrt(12.0), 0.03);
}

TEST(Distributions, Normal) {
    Distribution d;
    d.kind = DistributionKind::normal;
    d.mean = {10.0};
    d.deviation = {2.0};
    d.min = {-HUGE_VAL};
    d.max = {HUGE_VAL};
    const std::vector<double> values = numbers(d);
    EXPECT_NEAR(mean(values), 10.0, 5.0 * 2.0 / std::sqrt(double(draws)));
    EXPECT_NEAR(deviation(values), 2.0, 5.0 * 2.0 / std::sqrt(2.0 * draws));
    double within = 0.0;
    for (const double value : values) within += std::fabs(value - 10.0) < 2.0 ? 1.0 / draws : 0.0;
    EXPECT_NEAR(within, std::erf(std::sqrt(0.5)), 0.017);
    d.min = {11.0};
    d.max = {11.5};
    for (const double value : numbers(d)) EXPECT_TRUE(value >= 11.0 && value <= 11.5) << value;
}

TEST(Distributions, IntegerAndChoice) {
    Distribution d = uniform(-1.0, 2.0);
    d.kind = DistributionKind::integer;
    std::map<double, int> counts;
    for (const double value : numbers(d)) ++counts[value];
    ASSERT_EQ(counts.size(), 4u);
    for (const auto& [value, count] : counts)
        EXPECT_NEAR(count, draws / 4, 5.0 * std::sqrt(draws * 3.0 / 16.0)) << value;

    Distribution choice;
    choice.kind = DistributionKind::choice;
    choice.values = {"1", "2", "3"};
    choice.weights = {1.0, 0.0, 3.0};
    counts.clear();
    for (const double value : numbers(choice)) ++counts[value];
    EXPECT_EQ(counts.count(2.0), 0u);
    EXPECT_NEAR(counts[3.0], 0.75 * draws, 5.0 * std::sqrt(draws * 3.0 / 16.0));
}

TEST(Distributions, DecimalsAndArrays) {
    Distribution d = uniform(0.0, 1.0);
    d.decimals = 2;
    DrawStream stream(1, "x", 0);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(draw_value(d, stream).size(), 4u);
    d.array = true;
    d.min = {0.0, 5.0};
    d.max = {0.0, 5.0};
    EXPECT_EQ(draw_value(d, stream), "[0.00, 5.00]");
}

// The values of a plan are part of data sets: they must stay the same in all versions.
TEST(Distributions, TheValuesOfASeedStay) {
    SweepPlan plan;
    plan.samples = 3;
    plan.seed = 5;
    plan.axes = {axis_of("friction", uniform(0.0, 1.0))};
    plan.axes.front().source = [] {
        Distribution d = uniform(0.0, 1.0);
        d.decimals = 6;
        return d;
    }();
    std::vector<std::string> values;
    for (std::int64_t i = 0; i < 3; ++i) values.push_back(sample_of(plan, i).values.front());
    EXPECT_EQ(values, (std::vector<std::string>{"0.212204", "0.582010", "0.996320"}));
}

TEST(Samples, StreamsDifferByAxisDrawAndSeed) {
    std::set<double> first;
    for (const char* name : {"a", "b", "ab"})
        for (const std::uint64_t seed : {0, 1, 2})
            for (std::uint64_t draw = 0; draw < 100; ++draw) first.insert(DrawStream(seed, name, draw).unit());
    EXPECT_EQ(first.size(), 900u);
}

TEST(Samples, AnAxisWithItsOwnSeedIgnoresThatOfThePlan) {
    SweepPlan plan;
    plan.axes = {axis_of("a", uniform(0.0, 1.0)), axis_of("b", uniform(0.0, 1.0))};
    plan.axes[1].seed = 9;
    const SweepSample before = sample_of(plan, 4);
    plan.seed = 2;
    const SweepSample after = sample_of(plan, 4);
    EXPECT_NE(before.values[0], after.values[0]);
    EXPECT_EQ(before.values[1], after.values[1]);
}

TEST(Samples, MoreSamplesThanCombinationsRepeatThem) {
    SweepPlan plan;
    plan.axes = {{"a", {"a"}, ValueList{{"1", "2"}}, {}}, {"b", {"b"}, ValueList{{"3", "4", "5"}}, {}}};
    std::vector<std::vector<std::string>> values;
    for (std::int64_t i = 0; i < 7; ++i) values.push_back(sample_of(plan, i).values);
    EXPECT_EQ(values[1], (std::vector<std::string>{"1", "4"}));
    EXPECT_EQ(values[5], (std::vector<std::string>{"2", "5"}));
    EXPECT_EQ(values[6], values[0]);
}

TEST(Samples, APairThatCannotDifferIsAnError) {
    SweepPlan plan;
    plan.axes = {axis_of("a", uniform(1.0, 1.0))};
    plan.pair = PairPlan{{0}, std::monostate()};
    EXPECT_NO_THROW(sample_of(plan, 0));
    EXPECT_THROW(sample_of(plan, 1), InputError);
}

TEST(Samples, MultiplesOfAPairKeepWholeNumbersAndArrays) {
    SweepPlan plan;
    plan.axes = {{"a", {"a"}, ValueList{{"3", "[1.0, 2.0]"}}, {}}};
    plan.pair = PairPlan{{0}, PairFactor{2.0, 1.0}};
    EXPECT_EQ(sample_of(plan, 1).values.front(), "7");
    EXPECT_EQ(sample_of(plan, 3).values.front(), "[3.0, 5.0]");
    plan.axes = {{"a", {"a"}, ValueList{{"\"word\""}}, {}}};
    EXPECT_THROW(sample_of(plan, 1), InputError);
}

TEST(Names, FieldsOfValuesAreMadePlain) {
    SweepPlan plan;
    plan.axes = {{"path", {"a"}, ValueList{{"\"../a b\"", "[1.0, 2.0]", "-0.5"}}, {}}};
    plan.name = "x{path}_{index:03}";
    EXPECT_EQ(sample_of(plan, 0).name, "x.._a_b_000");
    EXPECT_EQ(sample_of(plan, 1).name, "x_1.0__2.0__001");
    EXPECT_EQ(sample_of(plan, 2).name, "x-0.5_002");
    plan.name = "{path}";
    EXPECT_THROW(sample_of(plan, 0), InputError) << "it would begin with a dot";
}

TEST(Names, BadTemplatesAreErrors) {
    SweepPlan plan;
    for (const char* name : {"", "/abs/{index}", "a/../{index}", "{index", "index}", "{index:x}", "{index:99}",
                             "{other}", "{pair}", "a//{index}", ".hidden/{index}", "{index}/"}) {
        plan.name = name;
        EXPECT_THROW(check_name_template(plan), InputError) << name;
    }
    plan.name = "train/{index:06}";
    EXPECT_NO_THROW(check_name_template(plan));
}

}  // namespace
}  // namespace tumble::sweep_sample_test
