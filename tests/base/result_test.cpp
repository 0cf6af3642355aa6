#include "stormcellar/base/result.h"

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(Error, TheCodeSaysWhoHasToChangeSomething) {
    EXPECT_EQ(cause_of(ErrorCode::corrupt), Cause::data);
    EXPECT_EQ(cause_of(ErrorCode::busy), Cause::system) << "the holder lets go of it";
    EXPECT_EQ(cause_of(ErrorCode::unmet), Cause::configuration) << "another budget can be met";
    EXPECT_FALSE(is_shortage(ErrorCode::busy)) << "whoever holds one lock holds up nobody else";
}

TEST(Error, ACallerWhoKnowsTheCauseSaysSo) {
    const Error error{ErrorCode::bad_argument, "x"};
    EXPECT_EQ(error.cause(), Cause::configuration);
    EXPECT_EQ(caused_by(Cause::data, error).cause(), Cause::data);
}

}  // namespace
}  // namespace stormcellar
