// Signals that ask the program to end are handled between two pieces of work, and never in the middle of a report.
#include "app/threads/interrupt.h"

#include <gtest/gtest.h>

#include <csignal>

namespace tumble::interrupt_test {
namespace {

/// The signal's disposition is the default one in every test; otherwise an unblocked signal would have no effect.
void expect_default_disposition() {
    struct sigaction action {};
    sigaction(SIGTERM, nullptr, &action);
    ASSERT_EQ(action.sa_handler, SIG_DFL) << "otherwise this test could not fail";
}

TEST(Interrupt, ASignalIsTakenOnce) {
    expect_default_disposition();
    Interrupt interrupt;
    EXPECT_FALSE(interrupt.pending());
    raise(SIGTERM);
    EXPECT_TRUE(interrupt.pending());
    EXPECT_FALSE(interrupt.pending());
}

TEST(Interrupt, ASignalThatComesAtTheEndIsDropped) {
    expect_default_disposition();
    {
        Interrupt interrupt;
        raise(SIGTERM);
    }  // would end this program if it were not dropped
    sigset_t waiting;
    sigpending(&waiting);
    EXPECT_EQ(sigismember(&waiting, SIGTERM), 0);
}

TEST(Interrupt, AfterTheFirstSignalTheNextEndsTheProgram) {
    expect_default_disposition();
    const auto two_signals = [] {
        Interrupt interrupt;
        raise(SIGTERM);
        interrupt.pending();
        raise(SIGTERM);
    };
    EXPECT_EXIT(two_signals(), ::testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace tumble::interrupt_test
