// Errors of the layers below as the exception of the interface; checks of arguments.
#pragma once

#include "core/error.h"
#include "core/safe_text.h"
#include "tumble/error.h"

#include <fmt/format.h>

#include <cfenv>
#include <exception>
#include <new>
#include <utility>

namespace tumble::v0 {

/// Rounding to nearest and denormal numbers while it lives, then the caller's own again: a program that is built with
/// -ffast-math, or that rounds otherwise, gets the same bytes. New threads inherit the state.
class DefaultFloatingPoint {
public:
    DefaultFloatingPoint() {
        std::fegetenv(&callers_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~DefaultFloatingPoint() { std::fesetenv(&callers_); }
    DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
    DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

private:
    std::fenv_t callers_;
};

/// Runs the work; InputError, RunError and other exceptions leave it as Error, std::bad_alloc as it is.
template <class Work>
decltype(auto) guarded(const Work& work) {
    const DefaultFloatingPoint default_floating_point;
    try {
        return work();
    } catch (const Error&) {
        throw;
    } catch (const InputError& error) {
        const SourceLocation& at = error.where();
        throw Error(ErrorKind::input, {at.file, at.line, at.column, {}}, error.message());
    } catch (const RunError& error) {
        throw Error(ErrorKind::run, {}, error.message());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(ErrorKind::run, {}, safe_lines(error.what()));
    }
}

inline void check_threads(int threads) {
    constexpr int most = 1024;  // beyond any machine; an absurd number is an argument that is wrong
    if (threads < 1 || threads > most)
        throw InputError(fmt::format("threads must be from 1 to {} (given {})", most, threads));
}

}  // namespace tumble::v0
