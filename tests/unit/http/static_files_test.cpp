#include <gtest/gtest.h>

#include <spindrift/http/static_files.h>

#include "temporary_folder.h"

namespace spindrift::net {
namespace {

namespace fs = std::filesystem;

struct StaticFilesTest : testing::Test {
  test::TemporaryFolder folder;

  void SetUp() override {
    folder.write("secret.txt", "secret");
    folder.write("web/index.html", "<h1>water</h1>");
    folder.write("web/assets/main-abc123.js", "run()");
    folder.write("web/.env", "hidden");
    folder.write("web/sub/page.html", "sub");
  }
  std::string root() const { return (folder.path() / "web").string(); }
};

TEST_F(StaticFilesTest, ServesTheIndexForTheRoot) {
  StaticFiles files(root());
  ASSERT_TRUE(files.find("/"));
  EXPECT_EQ(files.find("/")->content, "<h1>water</h1>");
  EXPECT_EQ(files.find("/"), files.find("/index.html")) << "from memory, both times the same file";
  EXPECT_EQ(files.find("/"), files.find("/pad")) << "the page of a class";
  EXPECT_FALSE(files.find("/")->immutable);
}

TEST_F(StaticFilesTest, MarksOnlyHashedAssetsAsImmutable) {
  StaticFiles files(root());
  EXPECT_TRUE(files.find("/assets/main-abc123.js")->immutable);
  EXPECT_FALSE(files.find("/sub/page.html")->immutable);
}

TEST_F(StaticFilesTest, ServesNothingOutsideTheRoot) {
  StaticFiles files(root());
  fs::create_symlink(folder.path() / "secret.txt", folder.path() / "web/link.txt");
  fs::create_directory_symlink(folder.path(), folder.path() / "web/up");
  for (const char* path : {"/../secret.txt", "/sub/../../secret.txt", "//etc/passwd", "/./index.html", "/link.txt",
                           "/up/secret.txt", "/.env", "/sub", "/sub/", "/assets", "", "index.html", "/nothing.html"}) {
    EXPECT_FALSE(files.find(path)) << path;
  }
}

TEST_F(StaticFilesTest, SeesThatAFileChanged) {
  StaticFiles files(root());
  const auto before = files.find("/index.html");
  folder.write("web/index.html", "<h1>more water</h1>");
  const auto after = files.find("/index.html");
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->content, "<h1>more water</h1>");
  EXPECT_NE(before->etag, after->etag);
}

TEST_F(StaticFilesTest, PrefersTheSmallestCodingThatTheClientTakes) {
  folder.write("web/index.html.gz", "gzip");
  folder.write("web/index.html.br", "br");
  folder.write("web/sub/page.html.gz", "gzip");
  StaticFiles files(root());
  const auto coding = [&](const char* path, const char* accepted) { return files.find(path, accepted)->coding; };
  EXPECT_EQ(coding("/", ""), "");
  EXPECT_EQ(coding("/", "gzip, deflate"), "gzip");
  EXPECT_EQ(coding("/", "gzip, deflate, br, zstd"), "br");
  EXPECT_EQ(coding("/", "*"), "br");
  EXPECT_EQ(coding("/", "br;q=0.5, gzip"), "gzip");
  EXPECT_EQ(coding("/", "identity, gzip;q=0.5"), "");
  EXPECT_EQ(coding("/", "gzip;q=0"), "");
  EXPECT_EQ(coding("/sub/page.html", "br, gzip"), "gzip");
  EXPECT_EQ(coding("/assets/main-abc123.js", "br, gzip"), "");
  EXPECT_EQ(files.find("/", "br"), files.find("/index.html", "br")) << "from memory, both times the same file";
  EXPECT_EQ(files.find("/index.html.br")->content_type, "application/octet-stream");
}

TEST_F(StaticFilesTest, ServesNoCompressedFileThatIsOlderThanTheOriginal) {
  folder.write("web/index.html.gz", "old");
  fs::last_write_time(folder.path() / "web/index.html.gz",
                      fs::last_write_time(folder.path() / "web/index.html") - std::chrono::minutes(2));
  StaticFiles files(root());
  EXPECT_EQ(files.find("/", "gzip")->content, "<h1>water</h1>");
}

TEST_F(StaticFilesTest, ServesNoCompressedFileFromOutsideTheRoot) {
  fs::create_symlink(folder.path() / "secret.txt", folder.path() / "web/index.html.gz");
  EXPECT_EQ(StaticFiles(root()).find("/", "gzip")->content, "<h1>water</h1>");
}

TEST_F(StaticFilesTest, ServesNothingWithoutARoot) {
  EXPECT_FALSE(StaticFiles("").find("/"));
  EXPECT_FALSE(StaticFiles((folder.path() / "missing").string()).find("/"));
  EXPECT_FALSE(StaticFiles((folder.path() / "secret.txt").string()).find("/"));
}

TEST(ContentType, KnowsTheFileTypesOfAWebClient) {
  EXPECT_EQ(contentType("index.html"), "text/html; charset=utf-8");
  EXPECT_EQ(contentType("a.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(contentType("a.mjs"), "text/javascript; charset=utf-8");
  EXPECT_EQ(contentType("a.css"), "text/css; charset=utf-8");
  EXPECT_EQ(contentType("a.json"), "application/json");
  EXPECT_EQ(contentType("a.js.map"), "application/json");
  EXPECT_EQ(contentType("a.wasm"), "application/wasm");
  EXPECT_EQ(contentType("a.svg"), "image/svg+xml");
  EXPECT_EQ(contentType("a.PNG"), "image/png");
  EXPECT_EQ(contentType("a.jpg"), "image/jpeg");
  EXPECT_EQ(contentType("favicon.ico"), "image/vnd.microsoft.icon");
  EXPECT_EQ(contentType("site.webmanifest"), "application/manifest+json");
  EXPECT_EQ(contentType("robots.txt"), "text/plain; charset=utf-8");
  EXPECT_EQ(contentType("a.woff2"), "font/woff2");
  EXPECT_EQ(contentType("a.exe"), "application/octet-stream");
  EXPECT_EQ(contentType("LICENSE"), "application/octet-stream");
}

}  // namespace
}  // namespace spindrift::net
