#include "tests/fault/steering_file.h"

#include <cstdio>
#include <new>
#include <stdexcept>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace stormcellar::fault {

SteeringFile::SteeringFile(const std::filesystem::path& file,
                           const std::vector<std::filesystem::path>& below, std::uint32_t kinds)
    : file_(file) {
    const int opened = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (opened < 0 || ::ftruncate(opened, sizeof(Steering)) != 0)
        throw std::runtime_error(file.native() + " cannot be made");
    void* mapped = ::mmap(nullptr, sizeof(Steering), PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
    ::close(opened);
    if (mapped == MAP_FAILED) throw std::runtime_error(file.native() + " cannot be mapped");
    steering_ = new (mapped) Steering;
    for (std::size_t i = 0; i < below.size(); ++i) {
        std::snprintf(steering_->below.at(i).data(), steering_->below.at(i).size(), "%s",
                      below[i].c_str());
    }
    steering_->kinds = kinds;
}

SteeringFile::~SteeringFile() {
    ::munmap(steering_, sizeof(Steering));
}

void SteeringFile::fail(std::uint64_t from, std::uint64_t count, int error_number) {
    steering_->error_number = error_number;
    steering_->to = count == UINT64_MAX ? UINT64_MAX : from + count;
    steering_->from = from;
}

std::map<std::string, std::string> SteeringFile::environment() const {
    return {{"LD_PRELOAD", FAILING_CALLS}, {"STORMCELLAR_FAILING_CALLS", file_.native()}};
}

}  // namespace stormcellar::fault
