#include "base/spawn.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "stormcellar/base/descriptor.h"
#include "tests/repository/text_of.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar {
namespace {

int status_of(pid_t child) {
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Spawn, WritesWhereItIsTold) {
    const testing::TemporaryDirectory directory;
    const Descriptor out{::open((directory / "out").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600)};
    const auto child =
        spawn("/bin/sh", {"-c", "cat; echo said; echo lost >&2; exit 7"}, {.out = out.number()});
    ASSERT_TRUE(child) << child.error().message;
    EXPECT_EQ(status_of(*child), 7);
    EXPECT_EQ(testing::text_of(directory / "out"), "said\n")
        << "the program should read an empty input";
}

TEST(Spawn, TheProgramInheritsNothingElse) {
    const testing::TemporaryDirectory directory;
    const Descriptor out{::open((directory / "out").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600)};
    const Descriptor open_to_all{::open("/dev/null", O_RDONLY)};  // without O_CLOEXEC
    const auto child = spawn("/bin/sh", {"-c", "ls /proc/$$/fd"}, {.out = out.number()});
    ASSERT_TRUE(child);
    EXPECT_EQ(status_of(*child), 0);
    EXPECT_EQ(testing::text_of(directory / "out"), "0\n1\n2\n");
}

TEST(Spawn, AProgramThatIsApartHasAGroupOfItsOwn) {
    for (const bool is_apart : {true, false}) {
        const auto child = spawn("/bin/sh", {"-c", "kill -STOP $$"}, {.is_apart = is_apart});
        ASSERT_TRUE(child);
        int status = 0;
        ASSERT_EQ(::waitpid(*child, &status, WUNTRACED), *child);
        EXPECT_EQ(::getpgid(*child) == *child, is_apart);
        ::kill(*child, SIGCONT);
        EXPECT_EQ(status_of(*child), 0);
    }
}

TEST(Spawn, SaysWhatIsNotThere) {
    const auto child = spawn("/no/such/program", {});
    ASSERT_FALSE(child);
    EXPECT_EQ(child.error().code, ErrorCode::not_found);
}

TEST(FindProgram, LooksBesideThisProgramAndOnThePath) {
    EXPECT_EQ(find_program("sh").filename(), "sh");
    EXPECT_EQ(find_program("base_test").filename(), "base_test")
        << "base_test is in the directory of the running program";
    EXPECT_EQ(find_program("no-such-program"), "");
}

}  // namespace
}  // namespace stormcellar
