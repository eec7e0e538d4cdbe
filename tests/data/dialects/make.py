"""Writes the test set of formats and dialects: one record, as other programs would have written it.

Each case is a file, its map, and maybe the line of the map without which the file has to be refused, naming
that line. The values are those of `truth.csv`. Run with pyarrow, zstandard, scipy, mcap, mcap-ros1-support and
mcap-ros2-support installed.
"""

import datetime
import gzip
import io
import json
import math
import pathlib

import mcap.writer
import mcap_ros1.writer
import mcap_ros2.writer
import numpy
import pyarrow
import pyarrow.parquet
import scipy.io
import zstandard
from mcap_ros1._vendor.genpy import dynamic

HERE = pathlib.Path(__file__).parent
GRAVITY = 9.80665
ROWS = 24
# Multiples of 2^-14 g are exact in binary; decimal texts have all their digits.
TIME = [60.0 * row for row in range(ROWS)]
ACCEL = [
    [round(16384 * math.sin(0.2 * row + axis)) / 16384 for axis in range(3)] for row in range(ROWS)
]
TEMPERATURE = [20.0 + row / 64 for row in range(ROWS)]
START = datetime.datetime(2026, 3, 1, 6, 0, tzinfo=datetime.timezone.utc)

cases = []


def number(value, comma=False):
    text = repr(float(value))
    return text.replace(".", ",") if comma else text


def rows(header, lines, delimiter=",", end="\n"):
    return end.join([header] + [delimiter.join(line) for line in lines]) + end


def plain(delimiter=",", names=("t", "ax", "ay", "az"), comma=False, scale=1.0, time=TIME, accel=ACCEL, end="\n"):
    lines = [
        [number(t, comma)] + [number(a * scale, comma) for a in row] for t, row in zip(time, accel)
    ]
    return rows(delimiter.join(names), lines, delimiter, end)


def stamped(stamps, name="t"):
    lines = [[stamp] + [number(a) for a in row] for stamp, row in zip(stamps, ACCEL)]
    return rows(f"{name},ax,ay,az", lines)


def case(name, content, time='column = "t"', accel='columns = ["ax", "ay", "az"]\nunit = "g"', file="", more="",
         line=None, form="csv", time_tolerance=1e-9, tolerance=1e-12, since_first=False, rows=ROWS, missing=()):
    path = HERE / f"{name}.{form}"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    text = (f"[file]\n{file}\n" if file else "") + f"[time]\n{time}\n[accel]\n{accel}\n" + more
    (HERE / f"{name}.map.toml").write_text(text)
    cases.append({
        "file": path.name, "map": f"{name}.map.toml", "without": line, "time_tolerance_s": time_tolerance,
        "tolerance_g": tolerance, "since_first": since_first, "missing": list(missing),
    })


case("names", plain(names=("Time [s]", "Accel X", "Accel Y", "Accel Z")), time='column = "Time [s]"',
     accel='columns = ["Accel X", "Accel Y", "Accel Z"]\nunit = "g"')
case("quoted_names", plain(names=('"t, s"', '"ax, g"', '"ay, g"', '"az, g"')), time='column = "t, s"',
     accel='columns = ["ax, g", "ay, g", "az, g"]\nunit = "g"')
for unit, scale in [("m/s2", GRAVITY), ("mg", 1e3), ("ug", 1e6), ("ft/s2", GRAVITY / 0.3048)]:
    more = f"[site]\ngravity_m_per_s2 = {GRAVITY}\n" if "s2" in unit else ""
    case("unit_" + unit.replace("/", "_"), plain(scale=scale), accel=f'columns = ["ax", "ay", "az"]\nunit = "{unit}"',
         more=more)
case("unit_signs", plain(scale=GRAVITY), accel='columns = ["ax", "ay", "az"]\nunit = "m/s²"',
     more=f"[site]\ngravity_m_per_s2 = {GRAVITY}\n")
case("unit_counts", plain(accel=[[16384 * a + 7 for a in row] for row in ACCEL]),
     accel='columns = ["ax", "ay", "az"]\nunit = "counts"\nzero_counts = 7\ncounts_per_g = 16384')
for unit, scale in [("s", 1.0), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)]:
    case("time_" + unit, plain(time=[t * scale for t in TIME]), time=f'column = "t"\nunit = "{unit}"')
case("time_hours", plain(time=[t / 3600 for t in TIME]), time='column = "t"\nunit = "h"')
stamps = [START + datetime.timedelta(seconds=t) for t in TIME]
case("time_rfc3339", stamped([s.isoformat().replace("+00:00", "Z") for s in stamps]),
     time='column = "t"\nunit = "rfc3339"', line='unit = "rfc3339"', since_first=True)
east = datetime.timezone(datetime.timedelta(hours=5, minutes=30))
case("time_offset", stamped([s.astimezone(east).isoformat(" ", "microseconds") for s in stamps]),
     time='column = "t"\nunit = "rfc3339"', line='unit = "rfc3339"', since_first=True)
# The week of the start begins on the Sunday before; two rows lie before midnight.
weeks = [(2407, 604800 - 120 + t) for t in TIME]
weeks = [(week + int(sow >= 604800), sow % 604800) for week, sow in weeks]
lines = [[str(w), number(s)] + [number(a) for a in row] for (w, s), row in zip(weeks, ACCEL)]
case("time_gps", rows("week,tow,ax,ay,az", lines),
     time='column = "tow"\nunit = "gps"\nweek_column = "week"', since_first=True)
case("time_excel", stamped([f"{46082.25 + t / 86400:.11f}" for t in TIME]), time='column = "t"\nunit = "excel"',
     time_tolerance=1e-5, since_first=True)
case("time_rate", rows("ax,ay,az", [[number(a) for a in row] for row in ACCEL]), time="rate_hz = 0.016666666666666666",
     time_tolerance=1e-6)
case("axes_signs", plain(accel=[[-a for a in row] for row in ACCEL]),
     accel='columns = ["ax", "ay", "az"]\nunit = "g"\naxes = ["-x", "-y", "-z"]')
case("axes_permuted", plain(accel=[[row[2], row[0], -row[1]] for row in ACCEL]),
     accel='columns = ["ax", "ay", "az"]\nunit = "g"\naxes = ["y", "-z", "x"]')
case("semicolon", plain(";"), file='delimiter = "semicolon"', line='delimiter = "semicolon"')
case("tab", plain("\t"), file='delimiter = "tab"', line='delimiter = "tab"', form="txt")
case("bar", plain("|"), file='delimiter = "bar"', line='delimiter = "bar"', form="txt")
case("blanks", plain("  "), file='delimiter = "space"', line='delimiter = "space"', form="txt")
case("decimal_comma", plain(";", comma=True), file='delimiter = "semicolon"\ndecimal = "comma"',
     line='decimal = "comma"')
lines = [[f'"{number(t, True)}"'] + [f'"{number(a, True)}"' for a in row] for t, row in zip(TIME, ACCEL)]
case("decimal_comma_quoted", rows("t,ax,ay,az", lines), file='decimal = "comma"', line='decimal = "comma"')
text = plain().split("\n")
case("comments", "\n".join(text[:3] + ["# the heater was switched on"] + text[3:]), file='comment = "#"',
     line='comment = "#"')
case("comments_percent", "\n".join(text[:9] + ["% 2,3"] + text[9:]), file='comment = "%"', line='comment = "%"')
case("preamble", "Logger 7\nSerial,4711\n\nOperator;A. B.\n" + plain())
case("units_row", "\n".join([text[0], "s,g,g,g"] + text[1:]), file="skip_rows = 1", line="skip_rows = 1")
case("no_header", "\n".join(text[1:]), file="header = false", time='column = "1"',
     accel='columns = ["2", "3", "4"]\nunit = "g"')
holes = [(3, 1), (7, 0), (7, 1), (7, 2)]


def with_holes(word):
    lines = [[number(t)] + [number(a) for a in row] for t, row in zip(TIME, ACCEL)]
    for row, axis in holes:
        lines[row][axis + 1] = word
    return rows("t,ax,ay,az", lines)


case("empty_cells", with_holes(""), missing=holes)
case("missing_words", with_holes("N/A"), file='missing = ["N/A"]', line='missing = ["N/A"]', missing=holes)
case("carriage_returns", plain(end="\r\n"))
case("byte_order_mark", "\ufeff" + plain())
jitter = [0.25 * math.sin(row * row) for row in range(ROWS)]
jitter[0] = jitter[-1] = 0.0
# On straight lines in time interpolation is exact.
shaken = [[(r + j) / 32, 1 - (r + j) / 64, (r + j) / 128] for r, j in enumerate(jitter)]
case("jitter", plain(time=[t + 60 * j for t, j in zip(TIME, jitter)], accel=shaken),
     time='column = "t"\njitter = "resample"')
cases[-1]["straight"] = True
lines = [[number(t)] + [number(a) for a in row] + ([number(temp * 1.8 + 32)] if index % 4 == 0 or index == ROWS - 1 else [""])
         for index, (t, row, temp) in enumerate(zip(TIME, ACCEL, TEMPERATURE))]
case("temperature", rows("t,ax,ay,az,T", lines), more='[temperature]\ncolumn = "T"\nunit = "F"\n')
cases[-1]["temperature"] = True
case("gzip", gzip.compress(plain().encode(), mtime=0), form="csv.gz")
case("zstandard", zstandard.ZstdCompressor().compress(plain().encode()), form="csv.zst")
wide = [[number(t), "ok", "12", *(number(a) for a in row), ""] for t, row in zip(TIME, ACCEL)]
case("other_columns", rows("t,state,count,ax,ay,az,", wide))


def parquet(name, columns, **options):
    path = HERE / f"{name}.parquet"
    pyarrow.parquet.write_table(pyarrow.table(columns), path, compression="snappy")
    content = path.read_bytes()
    case(name, content, form="parquet", **options)


axes = {f"a{axis}": [row[index] for row in ACCEL] for index, axis in enumerate("xyz")}
parquet("parquet", {"t": TIME, **axes})
parquet("parquet_stamps", {"t": pyarrow.array(stamps, pyarrow.timestamp("us", "UTC")), **axes}, since_first=True)


def matlab(name, variables, compressed=False, **options):
    content = io.BytesIO()
    scipy.io.savemat(content, variables, do_compression=compressed, oned_as="column")
    # Without the date.
    content = b"MATLAB 5.0 MAT-file".ljust(124) + content.getvalue()[124:]
    case(name, content, form="mat", **options)


values = numpy.array(ACCEL)
matlab("matlab", {"note": "a bench", "t": numpy.array(TIME), "accel": values},
       accel='columns = ["accel(:,1)", "accel(:,2)", "accel(:,3)"]\nunit = "g"')
log = {"t": numpy.array([int(t * 1000) for t in TIME], "int32"), "a": values.T.astype("float32"),
       "on": {"rate": 1.0}}
matlab("matlab_structure", {"log": log, "other": numpy.eye(3)}, compressed=True, time='column = "log.t"\nunit = "ms"',
       accel='columns = ["log.a(1,:)", "log.a(2,:)", "log.a(3,:)"]\nunit = "g"')

VECTOR = "float64 x\nfloat64 y\nfloat64 z\n"
IMU = """# This is a message to hold data from an IMU
{header}/Header header
geometry_msgs/Quaternion orientation
float64[9] orientation_covariance # row major about x, y, z axes
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance
"""
LINE = "=" * 80 + "\n"
PARTS = (LINE + "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
         + LINE + "MSG: geometry_msgs/Vector3\n" + VECTOR)
ROS2 = (IMU.format(header="std_msgs") + PARTS + LINE
        + "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
        + LINE + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")
ROS1 = (IMU.format(header="std_msgs") + PARTS + LINE
        + "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n")
ROS_AXES = 'columns = ["linear_acceleration.x", "linear_acceleration.y", "linear_acceleration.z"]\nunit = "m/s2"'
ROS_MORE = f"[site]\ngravity_m_per_s2 = {GRAVITY}\n"


def vector(row):
    return dict(zip("xyz", row))


def imu(stamp, row):
    return {
        "header": {"stamp": stamp, "frame_id": "bench"}, "orientation": {**vector([0.0] * 3), "w": 1.0},
        "orientation_covariance": [0.0] * 9, "angular_velocity": vector([0.0] * 3),
        "angular_velocity_covariance": [0.0] * 9, "linear_acceleration": vector([GRAVITY * a for a in row]),
        "linear_acceleration_covariance": [0.0] * 9,
    }


nanoseconds = [int(stamp.timestamp()) * 10**9 for stamp in stamps]
content = io.BytesIO()
writer = mcap_ros2.writer.Writer(content)
schema = writer.register_msgdef("sensor_msgs/msg/Imu", ROS2)
other = writer.register_msgdef("std_msgs/msg/Float64", "float64 data\n")
for at, row in zip(nanoseconds, ACCEL):
    message = imu({"sec": at // 10**9, "nanosec": 0}, row)
    writer.write_message("/imu/data", schema, message, log_time=at + 500, publish_time=at)
    writer.write_message("/pressure", other, {"data": 1e5}, log_time=at, publish_time=at)
writer.finish()
case("mcap_ros2", content.getvalue(), form="mcap", time='column = "header.stamp"', accel=ROS_AXES, more=ROS_MORE,
     since_first=True)


Imu = dynamic.generate_dynamic("sensor_msgs/Imu", ROS1)["sensor_msgs/Imu"]
content = io.BytesIO()
writer = mcap_ros1.writer.Writer(content, compression=mcap.writer.CompressionType.NONE)
for at, row in zip(nanoseconds, ACCEL):
    message = Imu()
    message.header.frame_id = "bench"
    message.linear_acceleration.x, message.linear_acceleration.y, message.linear_acceleration.z = (
        GRAVITY * a for a in row)
    writer.write_message("/imu/data", message, log_time=at, publish_time=at)
writer.finish()
case("mcap_ros1", content.getvalue(), form="mcap", time='column = "log_time"', accel=ROS_AXES, more=ROS_MORE,
     since_first=True)

content = io.BytesIO()
writer = mcap.writer.Writer(content, compression=mcap.writer.CompressionType.LZ4)
writer.start()
for topic in ["/upper", "/lower"]:
    schema = writer.register_schema(topic, "jsonschema", b"{}")
    channel = writer.register_channel(topic, "json", schema)
    sign = 1.0 if topic == "/upper" else -1.0
    for at, t, row in zip(nanoseconds, TIME, ACCEL):
        message = {"t": t, "acc": [sign * a for a in row], "state": None}
        writer.add_message(channel, at, json.dumps(message).encode(), at)
writer.finish()
only = 'only = { column = "topic", equals = "/upper" }'
case("mcap_json", content.getvalue(), form="mcap", file=only, line=only,
     accel='columns = ["acc.0", "acc.1", "acc.2"]\nunit = "g"')

(HERE / "truth.csv").write_text(
    rows("time_s,accel_x_g,accel_y_g,accel_z_g,temperature_c",
         [[number(t), *(number(a) for a in row), number(temp)] for t, row, temp in zip(TIME, ACCEL, TEMPERATURE)]))
(HERE / "cases.json").write_text(json.dumps(cases, indent=1) + "\n")
print(len(cases), "cases")
