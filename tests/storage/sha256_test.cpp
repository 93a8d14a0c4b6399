// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Oracles: the examples of FIPS 180-4 (NIST's example values), and the plain rounds for the processor's instructions.
#include "loopmark/storage/sha256.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "loopmark/core/error.hpp"
#include "loopmark/core/random.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::storage {
namespace {

std::string random_bytes(std::size_t count) {
  Rng rng(3);
  std::string bytes(count, '\0');
  for (char& byte : bytes) {
    byte = static_cast<char>(rng.uniform(0.0, 256.0));
  }
  return bytes;
}

TEST(Sha256, TheStandardsExamples) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, TheProcessorsInstructionsGiveWhatThePlainRoundsGive) {
  const std::string bytes = random_bytes(64 * 50);
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  for (const std::size_t blocks : {0, 1, 2, 49}) {
    Sha256State plain = {1, 2, 3, 4, 5, 6, 7, 8};
    Sha256State fast = plain;
    sha256_blocks_plain(plain, data, blocks);
    sha256_blocks(fast, data, blocks);
    EXPECT_EQ(plain, fast) << blocks;
  }
}

TEST(Sha256, PartsMakeTheWhole) {
  const std::string bytes = random_bytes(1000);
  for (std::size_t first = 0; first < 200; ++first) {
    Sha256 sum;
    sum.add(std::string_view(bytes).substr(0, first));
    sum.add(std::string_view(bytes).substr(first, 63));
    sum.add(std::string_view(bytes).substr(first + 63));
    ASSERT_EQ(sum.hex(), sha256_hex(bytes)) << first;
  }
}

TEST(Sha256, FilesAreReadInParts) {
  const std::filesystem::path file = testing::TempDir() + "loopmark_sha256_test";
  const std::string bytes = random_bytes(600'000);
  write_file_atomically(file, bytes);
  EXPECT_EQ(sha256_of_file(file), sha256_hex(bytes));
  write_file_atomically(file, "");
  EXPECT_EQ(sha256_of_file(file), sha256_hex(""));
  std::filesystem::remove(file);
  EXPECT_THROW(sha256_of_file(file), InputError);
  EXPECT_THROW(sha256_of_file(testing::TempDir()), InputError);
}

}  // namespace
}  // namespace loopmark::storage
