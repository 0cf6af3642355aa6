#include "accuracy/explain.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/accuracy/planner.h"
#include "tests/accuracy/small_chain.h"

namespace stormcellar::accuracy {
namespace {

using ::testing::HasSubstr;
using testing::plan_of;
using testing::small_chain;

TEST(Explain, ReadsAsIntended) {
    EXPECT_EQ(explain(plan_of(small_chain(), "250 m, 0.5 dB")),
              R"(Budget: 250 m, 0.5 dB
Chosen: beam: 4/3 earth, frame: ellipsoid, averaging: decibels
Time:   1.1 s predicted

     effect         predicted      of budget  by
off  refraction     200 m               80 %  proven
     The beam bends more or less than over a 4/3 earth.
     Why: small: all that is left off is within the budget.
on   ellipsoid      240 m               96 %  proven
     The earth is no sphere.
     Why: without it 470 m would be left off, of 250 m allowed.
off  geodesic       30 m                12 %  proven
     The shortest line is no normal section.
     Why: small: all that is left off is within the budget.
off  linear_mean    0.3 dB              60 %  sample
     Power adds up, decibels do not.
     Why: small: all that is left off is within the budget.
sum  of 3 left off  230 m, 0.3 dB       92 %

Measured: nothing, the plan rests on predictions.
)");
}

TEST(Explain, SaysWhatWasMeasured) {
    Plan made = plan_of(small_chain(), "250 m, 0.5 dB");
    made.measured_choices = 2;
    made.measuring_s = 0.04;
    EXPECT_THAT(explain(made), HasSubstr("Measured: 2 choices in 40 ms; this one rests on proven"));
    made.measured = Measured{};
    made.measured->value = 0.41;
    made.measured->status = {1000, 2};
    EXPECT_THAT(explain(made),
                HasSubstr("this one errs by at most (too few samples), 0.41 dB; the status differs "
                          "in 0.2 % of the cells compared.\n"));
}

TEST(Explain, ABudgetThatIsNotMetIsSaidLast) {
    Chain chain = small_chain();
    chain.steps[1].effects[0].setting = Setting::off;
    const std::string text = explain(plan_of(chain, "0 m"));
    EXPECT_THAT(text, HasSubstr("     Why: set off.\n"));
    EXPECT_THAT(text, HasSubstr("over  proven"));
    EXPECT_THAT(text, HasSubstr("\nNOT MET: no choice meets the budget of 0 m"));
    EXPECT_EQ(text.substr(text.size() - 11), "ellipsoid.\n");
}

TEST(Explain, ATimeHasNoShares) {
    const std::string text = explain(plan_of(small_chain(), "2.1 s"));
    EXPECT_THAT(text, HasSubstr("refraction     200 m                 -  proven"));
}

TEST(Explain, LongSentencesWrapAndHostileOnesStayPrintable) {
    Chain chain = small_chain();
    chain.steps[0].effects[0].what = "\x1b[2J";
    for (int i = 0; i < 60; ++i)
        chain.steps[0].effects[0].what += " word";
    std::istringstream lines(explain(plan_of(chain, "250 m, 0.5 dB")));
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(line.size(), 80U) << line;
        EXPECT_EQ(line.find('\x1b'), std::string::npos);
    }
}

}  // namespace
}  // namespace stormcellar::accuracy
