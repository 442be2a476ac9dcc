// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// Devices: which one is taken, what is said where none will do, and that
// validation is heard.
#include <cstring>
#include <numeric>

#include <gtest/gtest.h>

#include "errors.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/instance.h"
#include "gpu/physical_device.h"
#include "gpu/readable_buffer.h"
#include "gpu/result.h"
#include "render_delegate.h"

namespace nightcity::gpu {
namespace {

DeviceDescription device(const std::string& name, VkPhysicalDeviceType type) {
    DeviceDescription description;
    description.name = name;
    description.type = type;
    description.apiVersion = VK_API_VERSION_1_2;
    description.workGroupInvocations = 1024;
    DeviceFeatures& features = description.features;
    features.accelerationStructureExtension = true;
    features.deferredHostOperationsExtension = true;
    features.rayQueryExtension = true;
    features.accelerationStructure = true;
    features.rayQuery = true;
    features.bufferDeviceAddress = true;
    features.scalarBlockLayout = true;
    features.subgroupBallot = true;
    features.uniformArrayDynamicIndexing = true;
    features.uniformArrayNonUniformIndexing = true;
    features.storageArrayDynamicIndexing = true;
    features.storageArrayNonUniformIndexing = true;
    features.computeQueue = true;
    return description;
}

DeviceDescription withoutRayQuery(DeviceDescription description) {
    description.features.rayQueryExtension = false;
    description.features.rayQuery = false;
    return description;
}

std::string refusal(const std::vector<DeviceDescription>& devices, const std::string& wanted) {
    try {
        chooseDevice(devices, wanted);
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "";
}

const DeviceDescription kCpu = device("Software Rasterizer", VK_PHYSICAL_DEVICE_TYPE_CPU);
const DeviceDescription kDiscrete = device("Big Card 9000", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU);
const DeviceDescription kIntegrated =
    device("Small Chip", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU);

TEST(DeviceChoice, TakesTheFastestKindThatWillDo) {
    EXPECT_EQ(chooseDevice({kCpu, kIntegrated, kDiscrete}, "").name, kDiscrete.name);
    EXPECT_EQ(chooseDevice({kCpu, kIntegrated, withoutRayQuery(kDiscrete)}, "").name,
              kIntegrated.name);
    EXPECT_EQ(chooseDevice({withoutRayQuery(kDiscrete), kCpu}, "").name, kCpu.name);
}

TEST(DeviceChoice, TakesTheDeviceThatIsNamed) {
    EXPECT_EQ(chooseDevice({kCpu, kIntegrated, kDiscrete}, "1").name, kIntegrated.name);
    EXPECT_EQ(chooseDevice({kCpu, kIntegrated, kDiscrete}, "raster").name, kCpu.name);
    EXPECT_EQ(chooseDevice({kCpu, kDiscrete}, "card 9000").name, kDiscrete.name);
}

TEST(DeviceChoice, NamesWhatIsThereForAnUnknownDevice) {
    for (const char* wanted : {"3", "99999999999999999999", "voodoo"}) {
        const std::string message = refusal({kCpu, kIntegrated, kDiscrete}, wanted);
        EXPECT_NE(message.find(wanted), std::string::npos);
        EXPECT_NE(message.find("1: Small Chip"), std::string::npos) << message;
    }
}

TEST(DeviceChoice, NamesMissingRayQueryAndWhatCanBeDone) {
    const std::string message = refusal({withoutRayQuery(kDiscrete)}, "");
    EXPECT_NE(message.find("Big Card 9000"), std::string::npos) << message;
    EXPECT_NE(message.find("VK_KHR_ray_query"), std::string::npos) << message;
    EXPECT_NE(message.find("--method reference"), std::string::npos) << message;
    const std::string asked = refusal({kCpu, withoutRayQuery(kDiscrete)}, "big");
    EXPECT_NE(asked.find("VK_KHR_ray_query"), std::string::npos) << asked;
    EXPECT_NE(asked.find("another --device"), std::string::npos) << asked;
    EXPECT_NE(refusal({}, "").find("no Vulkan device"), std::string::npos);
}

TEST(DeviceChoice, NamesEveryFeatureThatIsMissing) {
    EXPECT_TRUE(kCpu.missing().empty());
    bool DeviceFeatures::*const members[] = {
        &DeviceFeatures::accelerationStructureExtension,
        &DeviceFeatures::deferredHostOperationsExtension,
        &DeviceFeatures::rayQueryExtension,
        &DeviceFeatures::accelerationStructure,
        &DeviceFeatures::rayQuery,
        &DeviceFeatures::bufferDeviceAddress,
        &DeviceFeatures::scalarBlockLayout,
        &DeviceFeatures::subgroupBallot,
        &DeviceFeatures::uniformArrayDynamicIndexing,
        &DeviceFeatures::uniformArrayNonUniformIndexing,
        &DeviceFeatures::storageArrayDynamicIndexing,
        &DeviceFeatures::storageArrayNonUniformIndexing,
        &DeviceFeatures::computeQueue,
    };
    for (const auto member : members) {
        DeviceDescription lacking = kCpu;
        lacking.features.*member = false;
        EXPECT_EQ(lacking.missing().size(), 1u);
    }
    DeviceDescription old = kCpu;
    old.apiVersion = VK_API_VERSION_1_1;
    EXPECT_EQ(old.missing(), std::vector<std::string>{"Vulkan 1.2"});
}

TEST(Results, AreNamedWithCallAndPurpose) {
    EXPECT_NO_THROW(check(VK_SUCCESS, "vkCall"));
    try {
        check(VK_ERROR_DEVICE_LOST, "vkQueueSubmit", "trace");
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_NE(std::strstr(error.what(), "vkQueueSubmit (trace)"), nullptr) << error.what();
        EXPECT_NE(std::strstr(error.what(), "VK_ERROR_DEVICE_LOST"), nullptr) << error.what();
    }
    EXPECT_EQ(resultName(static_cast<VkResult>(-12345)), "VkResult -12345");
}

class OnDevice : public testing::Test {
protected:
    Instance instance_{true};
    Device device_{instance_.get(), chooseDevice(describeDevices(instance_.get()), "")};
};

TEST_F(OnDevice, BuffersCarryBytesThereAndBack) {
    Commands commands(device_);
    std::vector<uint32_t> sent((40u << 20) / 4);  // more than a staging buffer
    std::iota(sent.begin(), sent.end(), 7u);
    Buffer source(device_, "source", sent.size() * 4, MemoryKind::device);
    EXPECT_NE(source.address(), 0u);
    EXPECT_GE(device_.ledger().bytes(), sent.size() * 4);
    commands.upload(source, sent.data(), sent.size() * 4);
    const ReadableBuffer target(device_, "target", sent.size() * 4);
    const double milliseconds = commands.run("copy", [&](VkCommandBuffer recording) {
        const VkBufferCopy all{0, 0, sent.size() * 4};
        computeBarrier(recording);
        vkCmdCopyBuffer(recording, source.get(), target.buffer().get(), 1, &all);
        computeBarrier(recording);
        target.recordReadback(recording);
    });
    EXPECT_GT(milliseconds, 0);
    EXPECT_EQ(std::memcmp(target.data(), sent.data(), sent.size() * 4), 0);
    Buffer moved = std::move(source);
    EXPECT_TRUE(moved);
    EXPECT_FALSE(source);  // NOLINT: a moved-from buffer is empty
    instance_.throwIfMessages();
}

TEST_F(OnDevice, MemoryIsCountedAndGivenBack) {
    const uint64_t before = device_.ledger().bytes();
    {
        const Buffer buffer(device_, "short-lived", 1u << 20, MemoryKind::upload);
        EXPECT_GE(device_.ledger().bytes(), before + (1u << 20));
    }
    EXPECT_EQ(device_.ledger().bytes(), before);
}

TEST_F(OnDevice, ABufferBeyondTheLimitIsRefusedByName) {
    try {
        const Buffer buffer(device_, "mountain", device_.limits().allocationBytes + 1,
                            MemoryKind::device);
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_NE(std::strstr(error.what(), "'mountain'"), nullptr) << error.what();
        EXPECT_NE(std::strstr(error.what(), device_.name().c_str()), nullptr) << error.what();
    }
}

TEST_F(OnDevice, AMisuseIsHeard) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = 0;  // not allowed
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    vkCreateBuffer(device_.get(), &info, nullptr, &buffer);
    vkDestroyBuffer(device_.get(), buffer, nullptr);
    EXPECT_THROW(instance_.throwIfMessages(), DeviceError);
    EXPECT_NO_THROW(instance_.throwIfMessages());  // each message once
}

TEST_F(OnDevice, ARaceIsHeard) {
    Commands commands(device_);
    const Buffer a(device_, "a", 1024, MemoryKind::device);
    const Buffer b(device_, "b", 1024, MemoryKind::device);
    commands.run("race", [&](VkCommandBuffer recording) {
        const VkBufferCopy all{0, 0, 1024};
        vkCmdCopyBuffer(recording, a.get(), b.get(), 1, &all);
        vkCmdCopyBuffer(recording, b.get(), a.get(), 1, &all);  // no barrier
    });
    EXPECT_THROW(instance_.throwIfMessages(), DeviceError);
}

TEST(Devices, AreListedWithIndexNameAndDriver) {
    const std::vector<std::string> lines = listDevices();
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines[0].substr(0, 3), "0: ");
}

TEST(Devices, UnknownDeviceIsRefused) {
    DeviceOptions options;
    options.device = "no such device";
    EXPECT_THROW(RenderDelegate::create(options), DeviceError);
}

}  // namespace
}  // namespace nightcity::gpu
