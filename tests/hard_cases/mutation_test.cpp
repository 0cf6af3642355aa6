// Damages real volumes in many ways (container_mutants.h, message_mutants.h), decodes them, and
// compares the results with the undamaged volumes. An ordinary run makes some mutants of the start
// and end of each volume. STORMCELLAR_MUTANTS=N makes N mutants of the container of the whole
// volume, and 10 N mutants of 8 MiB of its messages.
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/checksum.h"
#include "stormcellar/base/file_system.h"
#include "tests/hard_cases/container_mutants.h"
#include "tests/hard_cases/hard_oracle.h"
#include "tests/hard_cases/message_mutants.h"
#include "tests/level2/joined_files.h"
#include "tests/testing/data.h"
#include "tests/testing/test_name.h"

namespace stormcellar::level2 {
namespace {

namespace fs = std::filesystem;

#if defined(STORMCELLAR_SANITIZED)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif
constexpr long most_memory_kib = 1L << 20;  // without the sanitizers' own memory
constexpr unsigned hang_s = 120;

struct Size {
    std::uint64_t container_mutants = 0;
    std::uint64_t message_mutants = 0;
    std::size_t record_bytes = 0;  // compressed
    std::size_t stream_bytes = 0;
};

Size chosen_size() {
    const char* chosen = std::getenv("STORMCELLAR_MUTANTS");
    std::uint64_t mutants = 0;
    if (chosen != nullptr) {
        const std::string_view text = chosen;
        std::from_chars(text.data(), text.data() + text.size(), mutants);
    }
    if (mutants == 0) return {8, 66, 100'000, 500'000};
    return {mutants, 10 * mutants, SIZE_MAX, std::size_t{8} << 20};
}

// Returns the names of the volumes, of the files of a mosaic, and of two folders with the chunks of
// a volume.
std::vector<std::string> names() {
    const auto data = testing::data_directory();
    if (!data) return {"no_real_volumes"};
    std::vector<std::string> names = {"chunks/L2D_185", "chunks/KLOT_34"};
    for (const char* folder : {"volumes", "mosaic-northeast"}) {
        for (const auto& entry : fs::directory_iterator(*data / folder))
            names.push_back(fmt::format("{}/{}", folder, entry.path().filename().string()));
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<std::byte> bytes_of(const fs::path& path) {
    return fs::is_directory(path) ? joined_files(path) : read_file(path).value();
}

// Description of the current mutant, which say_current() prints after a crash or a hang.
char current[400];

void say_current(int signal_number) {
    std::signal(signal_number, SIG_DFL);
    for (const char* text : {"\nwhile decoding ", static_cast<const char*>(current), "\n"})
        (void)!::write(STDERR_FILENO, text, std::char_traits<char>::length(text));
    std::raise(signal_number);
}

long peak_memory_kib() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

// The figures of all volumes, printed at the end.
std::map<std::string, KindFigures> all_figures;

class FiguresPrinter : public ::testing::Environment {
  public:
    void TearDown() override {
        if (!all_figures.empty()) fmt::print("{}", table_of(all_figures));
    }
};
const ::testing::Environment* const figures_printer =
    ::testing::AddGlobalTestEnvironment(new FiguresPrinter);

class MutationTest : public ::testing::TestWithParam<std::string> {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        for (const int signal_number : {SIGALRM, SIGABRT})
            std::signal(signal_number, say_current);
        if constexpr (!sanitized) {  // sanitizers report faults better
            for (const int signal_number : {SIGSEGV, SIGFPE, SIGBUS})
                std::signal(signal_number, say_current);
        }
        const auto file = bytes_of(*testing::data_directory() / GetParam());
        const auto decoded = decode(file);
        ASSERT_TRUE(decoded) << decoded.error().message;
        const auto& corruption = decoded->report.corruption;
        volume_ = unpack(file, corruption ? std::optional{corruption->offset} : std::nullopt);
        if (!corruption) {
            EXPECT_EQ(volume_.radials, decoded->volume.radial_count());
        }
    }
    void TearDown() override { alarm(0); }

    template <class Make>
    void check(const UnpackedVolume& part, const wire::Bytes& file, std::uint64_t mutants,
               Make make) {
        Oracle oracle(file);
        ASSERT_EQ(oracle.radials(), part.radials);
        // Begin with another number for each volume, so that volumes get different mutants.
        const std::string& name = GetParam();
        const std::uint64_t first = crc32(std::as_bytes(std::span{name})) % 1000;
        for (std::uint64_t number = first; number < first + mutants; ++number) {
            const Mutant mutant = make(number);
            snprintf(current, sizeof current, "%s, %s", GetParam().c_str(), mutant.what.c_str());
            alarm(hang_s);
            const std::string wrong = oracle.check(mutant);
            EXPECT_EQ(wrong, "") << mutant.what;
        }
        fmt::print("{}: {} radials, {} mutants, slowest {:.3f} s, peak {} MiB\n", name,
                   oracle.radials(), mutants, oracle.slowest().count(), peak_memory_kib() >> 10);
        add(all_figures, oracle.figures());
        if (!sanitized) {
            EXPECT_LT(peak_memory_kib(), most_memory_kib);
        }
    }

    UnpackedVolume volume_;
    const Size size_ = chosen_size();
};

TEST_P(MutationTest, Containers) {
    if (volume_.records.empty()) {
        const UnpackedVolume part = short_stream(volume_, size_.stream_bytes);
        check(part, part.plain_file(), size_.container_mutants,
              [&](std::uint64_t number) { return gzip_mutant(part, number); });
        return;
    }
    const UnpackedVolume part = short_records(volume_, size_.record_bytes);
    check(
        part, part.ldm_file(), size_.container_mutants,
        [mutants = ContainerMutants(part)](std::uint64_t number) { return mutants.make(number); });
}

TEST_P(MutationTest, Messages) {
    const UnpackedVolume part = short_stream(volume_, size_.stream_bytes);
    check(part, part.plain_file(), size_.message_mutants,
          [mutants = MessageMutants(part)](std::uint64_t number) { return mutants.make(number); });
}

INSTANTIATE_TEST_SUITE_P(All, MutationTest, ::testing::ValuesIn(names()),
                         [](const auto& test) { return testing::test_name(test.param); });

}  // namespace
}  // namespace stormcellar::level2
