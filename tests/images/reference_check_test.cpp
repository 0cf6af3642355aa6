#include "tests/images/reference_check.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stormcellar::images {
namespace {

namespace fs = std::filesystem;
using render::Image;

class ReferenceCheck : public ::testing::Test {
  protected:
    void SetUp() override {
        if (std::getenv("STORMCELLAR_UPDATE_REFERENCES") != nullptr) {
            GTEST_SKIP() << "references are being written, not checked";
        }
    }
    void TearDown() override {
        std::error_code ignored;
        if (!directory_.empty()) fs::remove_all(directory_, ignored);
    }
    // Returns the directory that the message of a failure names.
    fs::path directory_in(const std::string& message) {
        const auto begin = message.find("look at ") + 8;
        directory_ = message.substr(begin, message.find(',', begin) - begin);
        return directory_;
    }
    fs::path directory_;
};

TEST_F(ReferenceCheck, AReferenceMatchesItself) {
    const auto reference = read_reference("composite");
    ASSERT_TRUE(reference) << reference.error().message;
    EXPECT_EQ(reference->width, 400);
    EXPECT_TRUE(matches_reference(*reference, "composite"));
}

TEST_F(ReferenceCheck, AnotherPictureIsStoredWithWhatDiffers) {
    const auto result = matches_reference(read_reference("section").value(), "composite");
    ASSERT_FALSE(result);
    const fs::path directory = directory_in(result.message());
    for (const char* name : {"actual.png", "reference.png", "difference.png"})
        EXPECT_GT(fs::file_size(directory / name), 1000U) << name;
    EXPECT_THAT(result.message(), ::testing::HasSubstr("worst tile"));
}

TEST_F(ReferenceCheck, WithoutAReferenceItFails) {
    const auto result = matches_reference(Image(20, 20, {1, 2, 3, 255}), "there-is-none");
    ASSERT_FALSE(result);
    EXPECT_THAT(result.message(), ::testing::HasSubstr("there-is-none.png"));
    EXPECT_TRUE(fs::exists(directory_in(result.message()) / "actual.png"));
    EXPECT_FALSE(read_reference("there-is-none"));
}

}  // namespace
}  // namespace stormcellar::images
