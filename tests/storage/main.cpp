// Entry of the storage tests: GoogleTest's, and `--long`.
#include "long_tests.hpp"

#include <gtest/gtest.h>

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    linefeed::test::read_long_option(argc, argv);
    return RUN_ALL_TESTS();
}
