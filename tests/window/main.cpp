#include <gtest/gtest.h>

#include <QApplication>
#include <QDir>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <cstdio>

namespace {

/// Says what Qt says, but not thousands of times that there is no screen: that would hide which test failed.
void say(QtMsgType, const QMessageLogContext&, const QString& message) {
  if (!message.startsWith("This plugin does not support")) std::fprintf(stderr, "%s\n", qPrintable(message));
}

}  // namespace

/// Without a screen, and in folders of its own: no test sees the home of the person who runs it.
int main(int argc, char** argv) {
  qInstallMessageHandler(say);
  const QTemporaryDir home;
  for (const char* name : {"HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "XDG_RUNTIME_DIR"})
    qputenv(name, home.path().toUtf8());
  if (qEnvironmentVariableIsEmpty("WALE_TEST_SCREEN")) qputenv("QT_QPA_PLATFORM", "offscreen");
  QApplication application(argc, argv);
  QDir::setSearchPaths("pages", {WALE_SOURCE_DIR});
  QApplication::setOrganizationName("wale");
  QApplication::setApplicationName("sandpaper");
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
