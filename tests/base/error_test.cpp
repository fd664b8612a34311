#include <hex/base/context.h>
#include <hex/base/diagnostics.h>
#include <hex/base/error.h>

#include <gtest/gtest.h>

namespace hex {
namespace {

TEST(Error, TextIsOneLineOfPlaceProblemAndAdvice) {
    const Error error(ErrorKind::bad_input, "9 nodes in a hexahedron", "a.k:12", "give 8");
    EXPECT_STREQ(error.what(), "a.k:12: 9 nodes in a hexahedron; give 8");
    EXPECT_STREQ(Error(ErrorKind::usage, "no such method").what(), "no such method");
    EXPECT_STREQ(Error(ErrorKind::usage, "a\nb\r\nc").what(), "a b  c");
}

TEST(Error, APlaceIsFilledInOnlyOnce) {
    const Error error(ErrorKind::bad_input, "empty", {}, "give a mesh");
    EXPECT_STREQ(error.located("a.stl").what(), "a.stl: empty; give a mesh");
    EXPECT_STREQ(error.located("a.stl").located("b.stl").what(), "a.stl: empty; give a mesh");
    EXPECT_EQ(error.located("a.stl").kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.located("a.stl").problem(), "empty");
    EXPECT_EQ(error.located("a.stl").advice(), "give a mesh");
}

TEST(Error, ExitCodesAreThoseOfTheContract) {
    EXPECT_EQ(exit_code(ErrorKind::quality), 1);
    EXPECT_EQ(exit_code(ErrorKind::usage), 2);
    EXPECT_EQ(exit_code(ErrorKind::bad_input), 3);
    EXPECT_EQ(exit_code(ErrorKind::unsupported), 3);
    EXPECT_EQ(exit_code(ErrorKind::no_result), 4);
    EXPECT_EQ(exit_code(ErrorKind::output), 5);
    EXPECT_EQ(exit_code(ErrorKind::cancelled), 130);
}

TEST(Diagnostics, AreCountedFromASeverityUpwards) {
    const Diagnostics all = {{Severity::note, "a", "", "", {}},
                             {Severity::warning, "b", "", "", {}},
                             {Severity::error, "c", "", "", {}},
                             {Severity::warning, "d", "", "", {}}};
    EXPECT_EQ(count_at_least(all, Severity::note), 4u);
    EXPECT_EQ(count_at_least(all, Severity::warning), 3u);
    EXPECT_EQ(count_at_least(all, Severity::error), 1u);
}

TEST(Diagnostics, LongListsOfIdsAreCutAndCounted) {
    EXPECT_EQ(list_ids({}), "");
    EXPECT_EQ(list_ids({5}), "5");
    EXPECT_EQ(list_ids({1, 2, 3}, 3), "1, 2, 3");
    EXPECT_EQ(list_ids({1, 2, 3, 4}, 3), "1, 2, 3, ... (4 in all)");
}

TEST(Context, ByDefaultDoesNothingAndNeverStops) {
    const Context context;
    context.progress("step", 0.5);
    context.log(LogLevel::error, "message");
    EXPECT_NO_THROW(context.check_cancelled());
}

TEST(Context, ThrowsCancelledOnceAStopWasAskedFor) {
    std::stop_source source;
    Context context;
    context.stop = source.get_token();
    EXPECT_NO_THROW(context.check_cancelled());
    source.request_stop();
    try {
        context.check_cancelled();
        FAIL() << "did not stop";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
}

}  // namespace
}  // namespace hex
