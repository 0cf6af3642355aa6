// Compares fold numbers with those on which Py-ART and UNRAVEL agree, and with the tornado of 3 May
// 1999, unfolded by hand gate by gate (../shared/data/velocity-golden).
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/dealias.h"
#include "tests/testing/data.h"

namespace stormcellar::retrieve {
namespace {

namespace fs = std::filesystem;
using Row = std::map<std::string, std::string>;

std::vector<std::string> fields_of(std::string line) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string> fields;
    std::istringstream text(line);
    for (std::string field; std::getline(text, field, ',');)
        fields.push_back(field);
    return fields;
}

std::vector<Row> rows_of(const fs::path& file) {
    std::ifstream text(file);
    std::string line;
    std::getline(text, line);
    const std::vector<std::string> names = fields_of(line);
    std::vector<Row> rows;
    while (std::getline(text, line)) {
        const std::vector<std::string> fields = fields_of(line);
        Row& row = rows.emplace_back();
        for (std::size_t i = 0; i < std::min(names.size(), fields.size()); ++i)
            row[names[i]] = fields[i];
    }
    return rows;
}

class Folds {
  public:
    Folds(const fs::path& file, Dealiasing rung) {
        const auto decoded = level2::decode_file(file);
        if (!decoded) throw std::runtime_error(decoded.error().message);
        found_ = dealias(decoded->volume, rung);
        for (const SweepFolds& sweep : found_.sweeps)
            strides_.push_back(
                decoded->volume.sweeps[sweep.sweep].moments[sweep.moment].gate_stride);
    }
    [[nodiscard]] int at(const Row& row) const {
        for (std::size_t i = 0; i < found_.sweeps.size(); ++i) {
            if (found_.sweeps[i].sweep != std::stoul(row.at("sweep"))) continue;
            return found_.sweeps[i]
                .folds[std::stoul(row.at("radial")) * static_cast<std::size_t>(strides_[i]) +
                       std::stoul(row.at("gate"))];
        }
        return -99;
    }

  private:
    Dealiased found_;
    std::vector<std::int32_t> strides_;
};

int fold_of(const Row& row, const char* column, double nyquist_mps) {
    return static_cast<int>(
        std::lround((std::stod(row.at(column)) - std::stod(row.at("raw_ms"))) / (2 * nyquist_mps)));
}

TEST(GoldenFolds, AgreeWhereOtherProgramsAgree) {
    STORMCELLAR_NEED_DATA();
    const fs::path data = *testing::data_directory();
    for (const Dealiasing rung : {Dealiasing::region, Dealiasing::anchored}) {
        int asked = 0, wrong = 0;
        for (const char* volume :
             {"KTLX19990503_235621.gz", "KLIX20050828_180149.gz", "KLBB20160601_150025_V06",
              "KCRP20170826_044114.trimmed.ar2v", "KDMX20220305_232324.trimmed.ar2v"}) {
            const Folds folds(data / "volumes" / volume, rung);
            for (const Row& row :
                 rows_of(data / "velocity-golden" / (std::string(volume) + ".csv"))) {
                if (row.at("agree_all") != "1") continue;
                ++asked;
                const double nyquist_mps = std::stod(row.at("nyquist_ms"));
                if (folds.at(row) != fold_of(row, "pyart_region_ms", nyquist_mps)) ++wrong;
            }
        }
        EXPECT_EQ(asked, 5207);
        EXPECT_LE(wrong, asked / 1000) << static_cast<int>(rung);
    }
}

// Ten gates of the tornado between Bridge Creek and Moore are folded. dealias() must find at least
// nine of them.
TEST(GoldenFolds, UnfoldTheTornadoOfMoore) {
    STORMCELLAR_NEED_DATA();
    const fs::path data = *testing::data_directory();
    const Folds folds(data / "volumes/KTLX19990503_235621.gz", Dealiasing::anchored);
    int folded = 0, found = 0, wrong = 0;
    for (const Row& row : rows_of(data / "velocity-golden/KTLX19990503_tornado_patch.csv")) {
        if (row.at("hand_sure") != "1") continue;
        const int by_hand = fold_of(row, "hand_ms", 26.1), ours = folds.at(row);
        if (by_hand != 0) ++folded;
        if (by_hand != 0 && ours == by_hand) ++found;
        if (ours != by_hand) ++wrong;
    }
    EXPECT_EQ(folded, 10);
    EXPECT_GE(found, 9);
    EXPECT_LE(wrong, 1);
}

// On 2026-11-29, islands of gates about jumps in shear were unfolded to -375 m/s.
TEST(GoldenFolds, NoGateIsFasterThanAnyWind) {
    STORMCELLAR_NEED_DATA();
    for (const char* file : {"KTLX19990503_235621.gz", "KLIX20050828_180149.gz"}) {
        const auto decoded = level2::decode_file(*testing::data_directory() / "volumes" / file);
        ASSERT_TRUE(decoded);
        const Dealiased found = dealias(decoded->volume, Dealiasing::anchored);
        for (const SweepFolds& sweep : found.sweeps)
            for (const std::int8_t fold : sweep.folds)
                ASSERT_LE(std::abs(fold), 2) << file << ", sweep " << sweep.sweep;
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
