#include "tests/fuzz/libfuzzer.h"
#include "tests/fuzz/properties.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    stormcellar::fuzz::check_request({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}
