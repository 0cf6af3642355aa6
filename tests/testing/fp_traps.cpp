#include "tests/testing/fp_traps.h"

#include <cfenv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

#include <execinfo.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace stormcellar::testing {
namespace {

constexpr int trapped = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

// Sets the traps. Clears pending exceptions first, so that they do not fire now.
int set_traps(int traps) {
    const int before = fegetexcept();
    std::feclearexcept(FE_ALL_EXCEPT);
    fedisableexcept(FE_ALL_EXCEPT);
    feenableexcept(traps);
    return before;
}

std::string_view kind_of(int code) {
    switch (code) {
        case FPE_FLTDIV:
            return "division by zero";
        case FPE_FLTOVF:
            return "overflow";
        case FPE_FLTINV:
            return "invalid operation";
        case FPE_INTDIV:
            return "integer division by zero";
        default:
            return "arithmetic error";
    }
}

void write_out(std::string_view text) {
    if (write(STDERR_FILENO, text.data(), text.size()) < 0) return;
}

// Prints what happened and where, then lets the signal end the program.
void report(int signal, siginfo_t* info, void* /*context*/) {
    write_out("floating-point trap: ");
    write_out(kind_of(info->si_code));
    write_out("\n");
    void* frames[24];
    backtrace_symbols_fd(frames, backtrace(frames, 24), STDERR_FILENO);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

// Turns traps on around the body of each test, so that GoogleTest's own code is not trapped.
class TrapEachTest : public ::testing::EmptyTestEventListener {
  public:
    void OnTestStart(const ::testing::TestInfo& /*test*/) override {
        traps_ = std::make_unique<FpTraps>();
    }
    void OnTestEnd(const ::testing::TestInfo& /*test*/) override { traps_.reset(); }

  private:
    std::unique_ptr<FpTraps> traps_;
};

class TrapEnvironment : public ::testing::Environment {
  public:
    void SetUp() override {
        const char* wanted = std::getenv("STORMCELLAR_FP_TRAPS");
        if (wanted == nullptr || std::strcmp(wanted, "1") != 0) return;
        struct sigaction action = {};
        action.sa_sigaction = report;
        action.sa_flags = SA_SIGINFO;
        sigaction(SIGFPE, &action, nullptr);
        ::testing::UnitTest::GetInstance()->listeners().Append(new TrapEachTest);
    }
};

// GoogleTest owns the object.
[[maybe_unused]] const ::testing::Environment* const environment =
    ::testing::AddGlobalTestEnvironment(new TrapEnvironment);

}  // namespace

FpTraps::FpTraps() : before_(set_traps(trapped)) {}

FpTraps::~FpTraps() {
    set_traps(before_);
}

bool fp_traps_are_on() {
    return (fegetexcept() & trapped) == trapped;
}

}  // namespace stormcellar::testing
