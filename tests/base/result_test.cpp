#include "stormcellar/base/result.h"

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

TEST(Error, TheCodeSaysWhoHasToChangeSomething) {
    EXPECT_EQ(cause_of(ErrorCode::corrupt), Cause::data);
    EXPECT_EQ(cause_of(ErrorCode::busy), Cause::system) << "another process will release the lock";
    EXPECT_EQ(cause_of(ErrorCode::unmet), Cause::configuration)
        << "the caller must ask for another budget";
    EXPECT_FALSE(is_shortage(ErrorCode::busy)) << "one held lock does not affect other files";
}

TEST(Error, ACallerWhoKnowsTheCauseSaysSo) {
    const Error error{ErrorCode::bad_argument, "x"};
    EXPECT_EQ(error.cause(), Cause::configuration);
    EXPECT_EQ(caused_by(Cause::data, error).cause(), Cause::data);
}

}  // namespace
}  // namespace stormcellar
