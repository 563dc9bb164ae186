import java.awt.Component;
import java.awt.Container;
import java.awt.EventQueue;
import java.awt.Window;
import java.awt.event.MouseEvent;
import java.io.IOException;
import java.lang.reflect.Field;
import java.nio.file.Files;
import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;
import java.util.concurrent.Callable;
import java.util.concurrent.FutureTask;
import javax.swing.JTable;

/**
 * A Java agent inside lcm-spy or the log player: reads what the window shows, as a user would, and
 * ends the program.
 *
 * <p>-javaagent:spy_probe.jar=spy:FILE, where FILE holds lines "CHANNEL TYPE": passes (exit 0) when
 * the table lists each channel with its type and messages, none undecodable, and a double click on
 * HEAD_POSE opens a panel that holds the numbers published. With player:FILE: passes when the log
 * player's table lists each channel. Fails (exit 1) after 30 s with the table.
 */
public final class SpyProbe {
  private static final long DEADLINE_MS = 30000;
  private static final int CHANNEL = 0, TYPE = 1, COUNT = 2, UNDECODABLE = 7;
  private static final double[] POSITION = {0.25, -0.5, 1};

  public static void premain(String argument) {
    String[] parts = argument.split(":", 2);
    Thread thread = new Thread(() -> run(parts[0].equals("player"), parts[1]), "SpyProbe");
    thread.setDaemon(true);
    thread.start();
  }

  private static void run(boolean player, String file) {
    String fault = "nothing seen";
    boolean clicked = false;
    try {
      List<String> expected = Files.readAllLines(Paths.get(file));
      long deadline = System.currentTimeMillis() + DEADLINE_MS;
      while (System.currentTimeMillis() < deadline) {
        Thread.sleep(200);
        fault = onEventThread(() -> tableFault(player, expected));
        if (!fault.isEmpty()) continue;
        if (!player) {
          if (!clicked) onEventThread(() -> doubleClick("HEAD_POSE"));
          clicked = true;
          fault = onEventThread(SpyProbe::panelFault);
        }
        if (fault.isEmpty()) {
          System.out.println("SpyProbe: all " + expected.size() + " channels as expected");
          Runtime.getRuntime().halt(0);
        }
      }
      System.out.println("SpyProbe: " + fault + "\n" + onEventThread(SpyProbe::tableText));
    } catch (Exception | Error e) {
      System.out.println("SpyProbe: " + e + " after: " + fault);
    }
    Runtime.getRuntime().halt(1);
  }

  private static <T> T onEventThread(Callable<T> call) throws Exception {
    FutureTask<T> task = new FutureTask<>(call);
    EventQueue.invokeAndWait(task);
    return task.get();
  }

  /** The visible components of class @p name or a class derived from it, in all windows. */
  private static List<Component> find(String name) {
    List<Component> found = new ArrayList<>();
    for (Window window : Window.getWindows()) {
      if (window.isShowing()) collect(window, name, found);
    }
    return found;
  }

  private static void collect(Component component, String name, List<Component> found) {
    for (Class<?> c = component.getClass(); c != null; c = c.getSuperclass()) {
      if (c.getName().equals(name)) found.add(component);
    }
    if (!(component instanceof Container)) return;
    for (Component child : ((Container) component).getComponents()) collect(child, name, found);
  }

  private static JTable table() throws IOException {
    List<Component> tables = find("javax.swing.JTable");
    if (tables.size() != 1) throw new IOException(tables.size() + " tables are shown");
    return (JTable) tables.get(0);
  }

  private static int row(JTable table, String channel) {
    for (int row = 0; row < table.getRowCount(); ++row) {
      if (channel.equals(table.getValueAt(row, CHANNEL))) return row;
    }
    return -1;
  }

  private static String tableFault(boolean player, List<String> expected) {
    JTable table;
    try {
      table = table();
    } catch (IOException e) {
      return e.getMessage();
    }
    for (String line : expected) {
      String[] wanted = line.split(" ");
      int row = row(table, wanted[0]);
      if (row < 0) return "channel " + wanted[0] + " is not in the table";
      if (player) continue;
      Object type = table.getValueAt(row, TYPE);
      if (!wanted[1].equals(type)) return "channel " + line + " has type " + type;
      if (Integer.parseInt("" + table.getValueAt(row, COUNT)) < 3) return line + " came too rarely";
      if (!"0".equals("" + table.getValueAt(row, UNDECODABLE))) return line + " is undecodable";
    }
    return "";
  }

  private static String tableText() throws IOException {
    JTable table = table();
    StringBuilder text = new StringBuilder();
    for (int row = 0; row < table.getRowCount(); ++row) {
      for (int column = 0; column < table.getColumnCount(); ++column) {
        text.append(table.getValueAt(row, column)).append('\t');
      }
      text.append('\n');
    }
    return text.toString();
  }

  private static Void doubleClick(String channel) throws IOException {
    JTable table = table();
    java.awt.Rectangle cell = table.getCellRect(row(table, channel), CHANNEL, true);
    table.dispatchEvent(
        new MouseEvent(table, MouseEvent.MOUSE_CLICKED, System.currentTimeMillis(),
            MouseEvent.BUTTON1_DOWN_MASK, cell.x + 5, cell.y + 5, 2, false, MouseEvent.BUTTON1));
    return null;
  }

  /** The panel that a double click opens: the message that it draws, and its numbers. */
  private static String panelFault() throws ReflectiveOperationException {
    List<Component> panels = find("lcm.spy.ObjectPanel");
    if (panels.size() != 1) return panels.size() + " panels are open";
    Field drawn = panels.get(0).getClass().getDeclaredField("o");
    drawn.setAccessible(true);
    Object message = drawn.get(panels.get(0));
    if (message == null) return "the panel is empty";
    if (!message.getClass().getName().equals("visavis.head_pose_t")) return "panel of " + message;
    double[] position = (double[]) message.getClass().getField("p_CM_m").get(message);
    return Arrays.equals(position, POSITION) ? "" : "p_CM_m is " + Arrays.toString(position);
  }
}
