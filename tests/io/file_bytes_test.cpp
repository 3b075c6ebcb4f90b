#include "io/file_bytes.h"

#include "pointreel/io.h"
#include "test_files.h"

namespace pointreel {
namespace {

namespace fs = std::filesystem;

std::size_t entry_count(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(ReadFile, GivesAllBytes) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\xff\n", 5);
  EXPECT_EQ(*io::read_file(folder.write("a", bytes)), bytes);
  EXPECT_EQ(*io::read_file(folder.write("empty", "")), "");
}

TEST(ReadFile, NamesWhatItCannotRead) {
  const TemporaryFolder folder;
  expect_error(io::read_file(folder.path() / "none"), ErrorCode::io_error, {"none", "No such file"});
  expect_error(io::read_file(folder.path()), ErrorCode::io_error, {folder.path().native(), "regular"});
  expect_error(io::read_file("/dev/zero"), ErrorCode::io_error, {"/dev/zero"});
}

TEST(ReadFile, RefusesSizesThatNoSweepHas) {
  const TemporaryFolder folder;
  const auto path = folder.write("sparse.bin", "");
  fs::resize_file(path, std::uintmax_t{1} << 40);
  expect_error(read_cloud(path), ErrorCode::resource_limit, {"sparse.bin"});
}

TEST(WriteFile, ReplacesAFileAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const auto path = folder.write("a", "old and longer");
  ASSERT_TRUE(io::write_file_atomically(path, "new"));
  EXPECT_EQ(file_bytes(path), "new");
  EXPECT_EQ(entry_count(folder.path()), 1u);
}

TEST(WriteFile, LeavesNothingBehindWhenItFails) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "taken");
  expect_error(io::write_file_atomically(folder.path() / "taken", "x"), ErrorCode::io_error, {"taken"});
  expect_error(io::write_file_atomically(folder.path() / "no_folder" / "a", "x"), ErrorCode::io_error,
               {"no_folder"});
  // The temporary name fits where this one does not, so that the rename is what fails.
  const std::string too_long(300, 'n');
  expect_error(io::write_file_atomically(folder.path() / too_long, "x"), ErrorCode::io_error, {too_long});
  EXPECT_EQ(entry_count(folder.path()), 1u);
}

TEST(WriteFile, DoesNotReplaceADevice) {
  expect_error(io::write_file_atomically("/dev/null", "x"), ErrorCode::io_error, {"/dev/null"});
}

}  // namespace
}  // namespace pointreel
