// Runs the program on files of ODIM_H5 and CfRadial as on Level II files.
#include <filesystem>
#include <fstream>
#include <memory>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_stormcellar.h"
#include "tests/testing/two_radar_files.h"

namespace stormcellar::cli {
namespace {

using testing::ProgramResult;

// Two simulated radars, and the second one as a file of another format.
class ForeignFiles : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        radars_ = std::make_unique<testing::TemporaryDirectory>();
        const auto files = testing::write_two_radars(radars_->path(), 0);
        first_ = files.at(0);
        second_ = files.at(1);
    }
    static void TearDownTestSuite() { radars_.reset(); }
    [[nodiscard]] std::string file(const std::string& name) const {
        return directory_.path() / name;
    }
    // Writes the second radar's volume, and returns the file.
    std::string converted(const std::string& name, const Words& options = {}) {
        const ProgramResult ran = run(with({"info", second_, "--to", file(name)}, options));
        EXPECT_EQ(ran.status, 0) << ran.err;
        return file(name);
    }
    nlohmann::json gridded(const Words& files) {
        const auto json = json_of(run(with(
            {"grid"}, files,
            {"-o", file("grid.nc"), "--json", "--spacing-km", "2", "--extent-km", "200,200"})));
        return json;
    }

    testing::TemporaryDirectory directory_;
    static inline std::unique_ptr<testing::TemporaryDirectory> radars_;
    static inline std::string first_, second_;
};

TEST_F(ForeignFiles, AreDescribedGriddedDrawnAndMerged) {
    const auto expected = gridded({second_});
    const auto merged = gridded({first_, second_});
    for (const auto& [name, container] :
         {std::pair{"x.h5", "ODIM_H5/V2_4"}, {"x.nc", "CfRadial 1.4"}}) {
        SCOPED_TRACE(name);
        const std::string other = converted(name);
        const auto facts = json_of(run({"info", other, "--json"}));
        EXPECT_EQ(facts.at("site"), "XSYB");
        EXPECT_EQ(facts.at("container"), container);
        const ProgramResult text = run({"info", other});
        EXPECT_NE(text.out.find(container), std::string::npos) << text.out;
        EXPECT_EQ(text.out.find("of messages"), std::string::npos) << text.out;

        const auto grid = gridded({other});
        EXPECT_EQ(grid.at("cells"), expected.at("cells"));
        EXPECT_EQ(grid.at("time"), expected.at("time"));
        EXPECT_EQ(gridded({first_, other}).at("cells"), merged.at("cells"));

        const ProgramResult drawn = run({"frame", other, "-o", file("picture.png")});
        EXPECT_EQ(drawn.status, 0) << drawn.err;
        EXPECT_TRUE(std::filesystem::exists(file("picture.png")));
        EXPECT_EQ(run({"frame", other, "--product", "ppi", "-o", file("sweep.png")}).status, 0);
    }
}

TEST_F(ForeignFiles, AreFoundInDirectoriesAndArchives) {
    const std::string inside = file("volumes");
    std::filesystem::create_directory(inside);
    std::filesystem::copy(converted("x.h5"), inside + "/x.h5");
    std::ofstream(inside + "/other.nc", std::ios::binary)
        << std::string("CDF\1", 4) << std::string(28, '\0');
    const ProgramResult ran = run({"info", inside});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_NE(ran.out.find("XSYB"), std::string::npos) << ran.out;
    EXPECT_NE(ran.err.find("neither ODIM_H5 nor CfRadial"), std::string::npos) << ran.err;
}

TEST_F(ForeignFiles, ThatAreDamagedAreNamed) {
    const std::string other = converted("x.h5");
    std::filesystem::resize_file(other, std::filesystem::file_size(other) / 2);
    for (const Words& command : {Words{"info", other}, Words{"frame", other, "-o", file("no.png")},
                                 Words{"grid", other, "-o", file("no.nc")}}) {
        const ProgramResult ran = run(command);
        EXPECT_EQ(ran.status, 1);
        EXPECT_NE(ran.err.find("x.h5: the HDF5 file is cut off"), std::string::npos) << ran.err;
    }
    EXPECT_FALSE(std::filesystem::exists(file("no.nc")));
}

}  // namespace
}  // namespace stormcellar::cli
