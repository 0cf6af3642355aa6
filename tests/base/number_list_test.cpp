#include "base/number_list.h"

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(NumberList, HoldsWhatIsWritten) {
    EXPECT_EQ(parse_numbers("1,-2.5,3e2", ','), (std::vector<double>{1, -2.5, 300}));
    EXPECT_EQ(parse_numbers("7", ':'), std::vector<double>{7});
}

TEST(NumberList, AnythingElseIsRefused) {
    for (const char* text :
         {"", ",", "1,", ",1", "1,,2", "1, 2", " 1", "1;2", "1,x", "inf", "nan", "1,1e999"}) {
        EXPECT_FALSE(parse_numbers(text, ',')) << '"' << text << '"';
    }
}

}  // namespace
}  // namespace stormcellar
