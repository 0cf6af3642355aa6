// tests/web/door_test.h -- a test that calls one door (the handler of a path), without a server.
#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "tests/web/asked.h"

namespace stormcellar::web {

// SetUp() of the test makes the door.
template <class AnyDoor, class Base = ::testing::Test>
class DoorTest : public Base {
  protected:
    Answer get(std::string_view target, Fields headers = {}) {
        return asked(*door_, target, std::move(headers));
    }
    std::unique_ptr<AnyDoor> door_;
};

}  // namespace stormcellar::web
