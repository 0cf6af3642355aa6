// tests/testing/temporary_directory.h -- directories that tests work in.
#pragma once

#include <filesystem>

namespace stormcellar {

namespace fs = std::filesystem;  // for all tests that include this header

namespace testing {

// A new directory, removed when the test ends.
class TemporaryDirectory {
  public:
    TemporaryDirectory();
    TemporaryDirectory(const TemporaryDirectory&) = delete;
    TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
    ~TemporaryDirectory();

    [[nodiscard]] const fs::path& path() const { return path_; }
    [[nodiscard]] fs::path operator/(const fs::path& name) const { return path_ / name; }

  private:
    fs::path path_;
};

// Changes to another working directory while the object exists.
class WorkingDirectory {
  public:
    explicit WorkingDirectory(const fs::path& path) { fs::current_path(path); }
    WorkingDirectory(const WorkingDirectory&) = delete;
    WorkingDirectory& operator=(const WorkingDirectory&) = delete;
    ~WorkingDirectory() { fs::current_path(before_); }

  private:
    const fs::path before_ = fs::current_path();
};

}  // namespace testing
}  // namespace stormcellar
