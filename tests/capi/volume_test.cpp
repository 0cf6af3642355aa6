// Opens volumes by the C interface, and compares them with those of the C++ library.
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fcntl.h>

#include "stormcellar/base/descriptor.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "tests/capi/opened.h"
#include "tests/testing/data.h"
#include "tests/testing/program.h"

namespace stormcellar::testing {
namespace {

const char* const storm = "volumes/KTLX19990503_235621.gz";

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(CVolume, TheVersionIsThatOfTheProgram) {
    EXPECT_EQ(std::string(stormcellar_version()).find_first_not_of("0123456789."),
              std::string::npos);
}

TEST(CVolume, FactsAreThoseOfTheFile) {
    STORMCELLAR_NEED_DATA();
    const OpenedVolume volume = opened(real_file(storm));
    const auto facts = facts_of(volume);
    EXPECT_STREQ(facts.station, "KTLX");
    EXPECT_NEAR(facts.latitude_deg, 35.333, 0.01);
    EXPECT_NEAR(facts.longitude_deg, -97.278, 0.01);
    EXPECT_EQ(facts.start_ms, 925775781000) << "1999-05-03 23:56:21 UTC";
    EXPECT_EQ(facts.vcp, 11);
    EXPECT_EQ(facts.volumes, 1);
    const auto decoded = level2::decode_file(real_file(storm));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(facts.sweeps, static_cast<int>(decoded->volume.sweeps.size()));
    EXPECT_EQ(facts.complete, decoded->report.complete ? 1 : 0);
    EXPECT_EQ(facts.problems, static_cast<int>(decoded->report.problems.size()));
}

TEST(CVolume, BytesAndDescriptorsGiveTheSameVolume) {
    STORMCELLAR_NEED_DATA();
    const auto file = real_file(storm);
    const std::string bytes = bytes_of(file);
    stormcellar_read_options options{};
    options.size = sizeof options;
    options.station = "KTLX";
    stormcellar_volume* volume = nullptr;
    ASSERT_EQ(stormcellar_volume_from_bytes(bytes.data(), bytes.size(), &options, &volume, nullptr),
              STORMCELLAR_OK);
    const OpenedVolume from_bytes(volume);
    const Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    ASSERT_EQ(stormcellar_volume_from_descriptor(descriptor.number(), &options, &volume, nullptr),
              STORMCELLAR_OK);
    const OpenedVolume from_descriptor(volume);
    const OpenedVolume from_path = opened(file);
    const auto expected = facts_of(from_path);
    for (const OpenedVolume* one : {&from_bytes, &from_descriptor}) {
        const auto facts = facts_of(*one);
        EXPECT_EQ(facts.sweeps, expected.sweeps);
        EXPECT_EQ(facts.start_ms, expected.start_ms);
        EXPECT_STREQ(facts.station, "KTLX");
    }
}

TEST(CVolume, OnlyTheNamedMomentsAreDecoded) {
    STORMCELLAR_NEED_DATA();
    stormcellar_read_options options{};
    options.size = sizeof options;
    options.moments = "REF";
    const OpenedVolume volume = opened(real_file(storm), &options);
    int32_t moment = 0;
    EXPECT_EQ(stormcellar_moment_find(volume.get(), 0, "REF", &moment, nullptr), STORMCELLAR_OK);
    for (int sweep = 0; sweep < facts_of(volume).sweeps; ++sweep) {
        EXPECT_EQ(stormcellar_moment_find(volume.get(), sweep, "VEL", &moment, nullptr),
                  STORMCELLAR_NOT_FOUND);
    }
}

TEST(CVolume, FailuresHaveACodeAndALine) {
    stormcellar_volume* volume = nullptr;
    stormcellar_error error{};
    EXPECT_EQ(stormcellar_volume_open("/nothing/here", nullptr, &volume, &error),
              STORMCELLAR_NOT_FOUND);
    EXPECT_EQ(error.code, STORMCELLAR_NOT_FOUND);
    EXPECT_NE(std::string(error.message).find("/nothing/here"), std::string::npos);
    EXPECT_EQ(volume, nullptr);
    EXPECT_EQ(stormcellar_volume_open("/", nullptr, &volume, nullptr), STORMCELLAR_NOT_A_FILE)
        << "an error may be null";
    EXPECT_EQ(stormcellar_volume_open(nullptr, nullptr, &volume, &error), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_volume_open("/", nullptr, nullptr, &error), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_volume_from_bytes(nullptr, 1, nullptr, &volume, &error),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_volume_from_bytes("", 0, nullptr, &volume, &error), STORMCELLAR_EMPTY);
    EXPECT_EQ(stormcellar_volume_from_bytes("no radar data", 13, nullptr, &volume, &error),
              STORMCELLAR_NOT_LEVEL2);
    EXPECT_EQ(stormcellar_volume_from_descriptor(-1, nullptr, &volume, &error), STORMCELLAR_IO);
    stormcellar_read_options options{};
    EXPECT_EQ(stormcellar_volume_open("/", &options, &volume, &error), STORMCELLAR_BAD_ARGUMENT)
        << "the size of the options is 0";
    options.size = sizeof options;
    options.moments = "REF XYZ";
    EXPECT_EQ(stormcellar_volume_open("/", &options, &volume, &error), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("XYZ"), std::string::npos);
    options.moments = nullptr;
    options.threads = -1;
    EXPECT_EQ(stormcellar_volume_open("/", &options, &volume, &error), STORMCELLAR_BAD_ARGUMENT);
    stormcellar_volume_free(nullptr);
}

TEST(CVolume, ALongMessageIsCutAtACharacter) {
    stormcellar_volume* volume = nullptr;
    stormcellar_error error{};
    std::string path = "/a";
    while (path.size() < 3000)
        path += "\u00e4";
    EXPECT_NE(stormcellar_volume_open(path.c_str(), nullptr, &volume, &error), STORMCELLAR_OK);
    const std::string message = error.message;
    EXPECT_GT(message.size(), 1010U);
    EXPECT_LT(message.size(), sizeof error.message);
    EXPECT_NE(static_cast<unsigned char>(message.back()), 0xC3) << "half a character";
}

TEST(CVolume, ACallerOfAnEarlierVersionGetsTheMembersThatItKnows) {
    STORMCELLAR_NEED_DATA();
    const OpenedVolume volume = opened(real_file(storm));
    stormcellar_volume_facts facts{};
    facts.size = offsetof(stormcellar_volume_facts, altitude_m);
    facts.altitude_m = 123;
    facts.vcp = 456;
    ASSERT_EQ(stormcellar_volume_describe(volume.get(), &facts, nullptr), STORMCELLAR_OK);
    EXPECT_STREQ(facts.station, "KTLX");
    EXPECT_EQ(facts.altitude_m, 123);
    EXPECT_EQ(facts.vcp, 456);
    EXPECT_EQ(facts.size, offsetof(stormcellar_volume_facts, altitude_m));
    facts.size = 0;
    EXPECT_EQ(stormcellar_volume_describe(volume.get(), &facts, nullptr), STORMCELLAR_BAD_ARGUMENT);
}

TEST(CVolume, ProblemsAreLines) {
    STORMCELLAR_NEED_DATA();
    std::string bytes = bytes_of(real_file("volumes/KLBB20160601_150025_V06"));
    bytes.resize(bytes.size() / 2);
    stormcellar_volume* made = nullptr;
    ASSERT_EQ(stormcellar_volume_from_bytes(bytes.data(), bytes.size(), nullptr, &made, nullptr),
              STORMCELLAR_OK);
    const OpenedVolume volume(made);
    const auto facts = facts_of(volume);
    EXPECT_EQ(facts.complete, 0);
    ASSERT_GT(facts.problems, 0);
    char text[200] = "";
    EXPECT_EQ(stormcellar_volume_problem(volume.get(), 0, text, sizeof text, nullptr),
              STORMCELLAR_OK);
    EXPECT_GT(std::strlen(text), 10U);
    char five[5];
    EXPECT_EQ(stormcellar_volume_problem(volume.get(), 0, five, sizeof five, nullptr),
              STORMCELLAR_OK);
    EXPECT_EQ(std::string(five), std::string(text).substr(0, 4));
    EXPECT_EQ(stormcellar_volume_problem(volume.get(), facts.problems, text, sizeof text, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_volume_problem(volume.get(), -1, text, sizeof text, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
}

TEST(CVolume, DerivedMomentsAreThoseOfTheLibrary) {
    STORMCELLAR_NEED_DATA();
    const OpenedVolume volume = opened(real_file(storm));
    stormcellar_derive_options options{};
    options.size = sizeof options;
    options.dealias = "region";
    options.quality = 0.5;
    stormcellar_volume* made = nullptr;
    stormcellar_error error{};
    ASSERT_EQ(stormcellar_volume_derive(volume.get(), "VELD POW", &options, &made, &error),
              STORMCELLAR_OK)
        << error.message;
    const OpenedVolume derived(made);
    auto expected = level2::decode_file(real_file(storm));
    ASSERT_TRUE(expected);
    const std::vector wanted{level2::Moment::veld, level2::Moment::pow};
    ASSERT_TRUE(retrieve::add_derived_moments(
        expected->volume, wanted, {.dealiasing = retrieve::Dealiasing::region, .quality = 0.5}));
    std::size_t compared = 0;
    for (std::size_t i = 0; i < expected->volume.sweeps.size(); ++i) {
        const auto sweep = static_cast<std::int32_t>(i);
        for (const level2::Moment moment : wanted) {
            const level2::SweepMoment* one = expected->volume.sweeps[i].find(moment);
            std::int32_t number = 0;
            const auto found = stormcellar_moment_find(
                derived.get(), sweep, std::string(level2::moment_name(moment)).c_str(), &number,
                nullptr);
            ASSERT_EQ(found == STORMCELLAR_OK, one != nullptr);
            if (one == nullptr) continue;
            const void* codes = nullptr;
            ASSERT_EQ(stormcellar_moment_codes(derived.get(), sweep, number, &codes, nullptr),
                      STORMCELLAR_OK);
            const bool is_short = one->word_size_bits == 8;
            const std::size_t size = is_short ? one->codes8.size() : 2 * one->codes16.size();
            const void* right = is_short ? static_cast<const void*>(one->codes8.data())
                                         : static_cast<const void*>(one->codes16.data());
            EXPECT_EQ(std::memcmp(codes, right, size), 0);
            compared += size;
        }
    }
    EXPECT_GT(compared, 1'000'000U);
}

TEST(CVolume, DerivingRefusesWhatMakesNoSense) {
    STORMCELLAR_NEED_DATA();
    const OpenedVolume volume = opened(real_file(storm));
    stormcellar_derive_options options{};
    options.size = sizeof options;
    stormcellar_volume* made = nullptr;
    stormcellar_error error{};
    const auto derive = [&](const char* moments) {
        return stormcellar_volume_derive(volume.get(), moments, &options, &made, &error);
    };
    EXPECT_EQ(derive("DBZH"), STORMCELLAR_BAD_ARGUMENT);
    options.dealias = "magic";
    EXPECT_EQ(derive("VELD"), STORMCELLAR_BAD_ARGUMENT);
    options.dealias = nullptr;
    options.quality = std::nan("");
    EXPECT_EQ(derive("VELD"), STORMCELLAR_BAD_ARGUMENT);
    options.quality = 0;
    options.storm_motion = "sideways";
    EXPECT_EQ(derive("SRV"), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(made, nullptr);
}

// The example is compiled as C99, and the library exports only the functions of the header.
TEST(CVolume, TheExampleInCRuns) {
    STORMCELLAR_NEED_DATA();
    const ProgramResult said = run_program(STORMCELLAR_STRONGEST_ECHO, {real_file(storm).string()});
    EXPECT_EQ(said.status, 0) << said.err;
    EXPECT_NE(said.out.find("KTLX, complete\n"), std::string::npos) << said.out;
    EXPECT_NE(said.out.find("dBZ at azimuth"), std::string::npos);
    const ProgramResult refused = run_program(STORMCELLAR_STRONGEST_ECHO, {"/nothing"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("/nothing"), std::string::npos);
}

TEST(CVolume, TheExampleInRustFindsTheTornado) {
#ifdef STORMCELLAR_RUSTC
    STORMCELLAR_NEED_DATA();
    const TemporaryDirectory directory;
    const std::string library = std::filesystem::path(STORMCELLAR_SHARED).parent_path();
    const std::string program = directory / "strongest_rotation";
    const ProgramResult compiled = run_program(
        STORMCELLAR_RUSTC, {"--edition", "2021", "-D", "warnings", "-L", library, "-C",
                            "link-arg=-Wl,-rpath," + library, "-o", program,
                            source_directory() / "docs/examples/strongest_rotation.rs"});
    ASSERT_EQ(compiled.status, 0) << compiled.err;
    const ProgramResult said = run_program(program, {real_file(storm).string()});
    EXPECT_EQ(said.status, 0) << said.err;
    EXPECT_NE(said.out.find("KTLX\nelevation 0.5 degrees: shear of 0.04"), std::string::npos)
        << said.out;
    EXPECT_NE(said.out.find("at azimuth 257 degrees, range 38 km\n"), std::string::npos)
        << "the tornado of Bridge Creek and Moore; " << said.out;
    const ProgramResult refused = run_program(program, {"/nothing"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("/nothing"), std::string::npos);
#else
    GTEST_SKIP() << "no rustc, or built with sanitizers: the example in Rust is not compiled";
#endif
}

TEST(CVolume, TheLibraryExportsTheFunctionsOfTheHeaderAlone) {
    const ProgramResult names =
        run_program("/usr/bin/nm", {"-D", "--defined-only", STORMCELLAR_SHARED});
    ASSERT_EQ(names.status, 0) << names.err;
    const std::string header = bytes_of(source_directory() / "include/stormcellar.h");
    std::istringstream lines(names.out);
    int count = 0;
    for (std::string place, kind, name; lines >> place >> kind >> name;) {
        if (name == "STORMCELLAR_0") continue;
        ASSERT_TRUE(name.ends_with("@@STORMCELLAR_0")) << name;
        const std::string function = name.substr(0, name.find('@'));
        EXPECT_NE(header.find(function + "("), std::string::npos) << function;
        ++count;
    }
    std::size_t declared = 0;
    for (auto at = header.find("STORMCELLAR_API "); at != std::string::npos;
         at = header.find("STORMCELLAR_API ", at + 1))
        ++declared;
    // One more occurrence is the definition of STORMCELLAR_API with a value.
    EXPECT_EQ(static_cast<std::size_t>(count) + 1, declared);
}

}  // namespace
}  // namespace stormcellar::testing
