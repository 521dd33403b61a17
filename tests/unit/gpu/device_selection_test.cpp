// Selection among imaginary devices.
#include "device_selection.h"

#include <cerrno>
#include <map>

#include <gmock/gmock.h>

#include "device_needs.h"

namespace spindrift::gpu {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Kind = DeviceChoice::Kind;

egl::Candidate hardware(int index, const std::string& drm_file = "", const std::string& uuid = "") {
  egl::Candidate c;
  c.index = index;
  c.drm_file = drm_file;
  c.uuid = uuid;
  return c;
}

egl::Candidate software() {
  egl::Candidate c;
  c.is_software = true;
  return c;
}

/// Opens only the devices in `working` (by drm_file, "" for software).
class Selecting : public testing::Test {
 protected:
  egl::Attempt open(const egl::Candidate& c) {
    tried.push_back(c.drm_file);
    egl::Attempt attempt;
    attempt.info.index = c.index;
    attempt.info.is_software = c.is_software;
    attempt.info.drm_file = c.drm_file;
    attempt.info.name = c.is_software ? "llvmpipe" : "GPU at " + c.drm_file;
    if (std::ranges::find(working, c.drm_file) != working.end()) {
      attempt.handles = egl::Handles{};
      ++open_count;
    } else {
      attempt.info.problem = "the probe program does not compile: unknown";
    }
    return attempt;
  }
  core::Result<egl::Attempt> select(const DeviceChoice& choice = {}) {
    const Machine machine{.variable =
                              [this](const std::string& name) {
                                const auto found = variables.find(name);
                                return found == variables.end() ? nullptr : found->second.c_str();
                              },
                          .opening_error =
                              [this](const std::string& file) {
                                const auto found = files.find(file);
                                return found == files.end() ? ENOENT : found->second;
                              }};
    return selectDevice(
        candidates, choice, [this](const auto& c) { return open(c); }, [this](const auto&) { --open_count; }, machine);
  }
  std::vector<DeviceInfo> describe() {
    return describeDevices(
        candidates, [this](const auto& c) { return open(c); }, [this](const auto&) { --open_count; });
  }

  std::vector<egl::Candidate> candidates;
  std::map<std::string, std::string> variables;  ///< of the environment
  std::map<std::string, int> files;              ///< errno of opening; others do not exist
  std::vector<std::string> working;
  std::vector<std::string> tried;
  int open_count = 0;
};

TEST_F(Selecting, AutoTakesTheNextDeviceWhenTheProbeFails) {
  candidates = {hardware(0, "card0"), hardware(1, "card1"), software()};
  working = {"card1", ""};
  const auto selected = select();
  ASSERT_TRUE(selected);
  EXPECT_EQ(selected->info.index, 1);
  EXPECT_THAT(
      selected->info.why,
      AllOf(HasSubstr("device 1 (GPU at card1): first hardware device"),
            HasSubstr("not used: device 0 (GPU at card0): the probe program does not compile"), Not(HasSubstr("\n"))));
  EXPECT_EQ(open_count, 1);
}

TEST_F(Selecting, AutoFallsBackToSoftwareWithTheReason) {
  candidates = {hardware(0, "card0"), software()};
  working = {""};
  const auto selected = select();
  ASSERT_TRUE(selected);
  EXPECT_TRUE(selected->info.is_software);
  EXPECT_THAT(selected->info.why, HasSubstr("software, because no hardware device works; not used: device 0"));
}

TEST_F(Selecting, AutoAdvisesWhereHardwareIsNotUsed) {
  candidates = {hardware(0, "card0"), software()};
  working = {""};
  EXPECT_THAT(select()->info.advice, AllOf(HasSubstr("make the hardware usable"), HasSubstr("--device software")));
  variables["MESA_LOADER_DRIVER_OVERRIDE"] = "kms_swrast";
  EXPECT_THAT(select()->info.advice, HasSubstr("(MESA_LOADER_DRIVER_OVERRIDE=kms_swrast): unset that"));
  EXPECT_THAT(select({.kind = Kind::kSoftware})->info.advice, IsEmpty()) << "asked for";
  working = {"card0", ""};
  EXPECT_THAT(select()->info.advice, IsEmpty());
}

TEST_F(Selecting, AutoAdvisesWhereEglDoesNotListTheHardware) {
  candidates = {software()};
  working = {""};
  EXPECT_THAT(select()->info.advice, IsEmpty()) << "no advice is needed";
  files["/dev/dri/renderD128"] = EACCES;
  EXPECT_THAT(select()->info.advice, HasSubstr("this user may not open /dev/dri/renderD128: add it to the group"));
  files["/dev/dri/renderD128"] = 0;
  EXPECT_THAT(select()->info.advice, HasSubstr("there is a GPU (/dev/dri/renderD128): install its driver for EGL"));
  files["/dev/nvidiactl"] = 0;
  EXPECT_THAT(select()->info.advice, HasSubstr("NVIDIA_DRIVER_CAPABILITIES"));
}

TEST_F(Selecting, DeviceIsFoundByItsFilesAndUuid) {
  const std::string uuid = "01234567-89ab-cdef-0123-456789abcdef";
  candidates = {hardware(0, "card0"), hardware(1, "card1", uuid), software()};
  candidates[1].render_file = "renderD129";
  working = {"card0", "card1", ""};
  for (const std::string& name : {std::string("card1"), std::string("renderD129"), uuid}) {
    const auto selected = select({.kind = Kind::kName, .name = name});
    ASSERT_TRUE(selected) << name;
    EXPECT_EQ(selected->info.index, 1) << name;
  }
  const auto unknown = select({.kind = Kind::kName, .name = "renderD130"});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(
      unknown.error().message,
      HasSubstr("device renderD130 does not exist: EGL lists the hardware devices 0 card0, 1 card1 renderD129 " +
                uuid));
}

TEST_F(Selecting, TheVariablesAreTheAdviceWhereNothingWorks) {
  candidates = {software()};
  variables["GALLIUM_DRIVER"] = "softpipe";
  EXPECT_THAT(select().error().message,
              AllOf(HasSubstr("(GALLIUM_DRIVER=softpipe): unset that"), Not(HasSubstr("apt"))));
}

TEST(DeviceAdvice, SaysWhyAFileCannotBeOpened) {
  const auto adviceFor = [](int error) {
    return fileAdvice("/dev/dri/renderD128",
                      {.variable = {}, .opening_error = [error](const std::string&) { return error; }});
  };
  EXPECT_THAT(adviceFor(0), IsEmpty());
  EXPECT_THAT(adviceFor(EACCES),
              AllOf(HasSubstr("this user may not open /dev/dri/renderD128"), HasSubstr("--group-add")));
  EXPECT_THAT(adviceFor(ENOENT), HasSubstr("--device /dev/dri/renderD128"));
  EXPECT_THAT(fileAdvice("", {}), IsEmpty()) << "EGL does not name a file";
}

TEST_F(Selecting, ErrorListsEveryAttempt) {
  candidates = {hardware(0, "card0"), software()};
  const auto selected = select();
  ASSERT_FALSE(selected);
  EXPECT_EQ(selected.error().code, core::ErrorCode::kNoDevice);
  EXPECT_THAT(selected.error().message,
              AllOf(HasSubstr("GPU at card0"), HasSubstr("llvmpipe"), HasSubstr("apt install")));
}

TEST_F(Selecting, AnIndexIsNotReplacedByAnotherDevice) {
  candidates = {hardware(0, "card0"), hardware(1, "card1"), software()};
  working = {"card1", ""};
  EXPECT_FALSE(select({.kind = Kind::kIndex, .index = 0}));
  EXPECT_THAT(tried, ElementsAre("card0"));
  EXPECT_FALSE(select({.kind = Kind::kIndex, .index = 2})) << "there are two";
}

TEST_F(Selecting, GpuListedTwiceHasOneIndex) {
  candidates = {hardware(-1, "card0"),
                hardware(-1, "card1", "0123456789abcdef"),
                hardware(-1, "card0"),
                hardware(-1, "", "0123456789abcdef"),
                hardware(-1),
                hardware(-1),
                software()};
  mergeDuplicates(candidates);
  std::vector<int> indices;
  for (const auto& c : candidates) indices.push_back(c.index);
  EXPECT_THAT(indices, ElementsAre(0, 1, 0, 1, 2, 3, -1)) << "what EGL does not tell apart stays apart";
}

TEST_F(Selecting, SecondLibraryIsTakenWhenTheFirstFails) {
  candidates = {hardware(-1, "card0", "a"), hardware(-1, "nvidia0", "a"), software()};
  mergeDuplicates(candidates);
  working = {"nvidia0", ""};
  const auto selected = select({.kind = Kind::kIndex, .index = 0});
  ASSERT_TRUE(selected);
  EXPECT_EQ(selected->info.drm_file, "nvidia0");

  const auto devices = describe();
  ASSERT_EQ(devices.size(), 2u);
  EXPECT_EQ(devices[0].drm_file, "nvidia0");
  EXPECT_THAT(devices[0].problem, IsEmpty());
  EXPECT_TRUE(devices[1].is_software);
  EXPECT_EQ(open_count, 1) << "the selected one; describing closes what it opens";
}

TEST(DeviceNeeds, NamesEachLimitThatIsTooLow) {
  EXPECT_THAT(missingLimits(kNeededLimits), IsEmpty());
  DeviceLimits low = kNeededLimits;
  low.max_ssbo_bindings = 8;
  low.max_work_group_invocations = 128;
  EXPECT_EQ(missingLimits(low),
            "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS is 128, at least 256 is needed, "
            "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS is 8, at least 40 is needed");
  EXPECT_THAT(missingLimits(DeviceLimits{}), HasSubstr("GL_MAX_SHADER_STORAGE_BLOCK_SIZE is 0"));
}

}  // namespace
}  // namespace spindrift::gpu
