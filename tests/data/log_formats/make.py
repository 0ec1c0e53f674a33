"""Small logs in the formats that readers know by name, and what stands in them. `python3 make.py` writes them anew."""


def crc(text):
    """NovAtel's CRC-32: reflected polynomial EDB88320, from zero, not inverted at the end."""
    value = 0
    for byte in text.encode():
        value ^= byte
        for _ in range(8):
            value = (value >> 1) ^ (0xEDB88320 if value & 1 else 0)
    return f"{value:08x}"


def message(head, body):
    line = f"{head};{body}"
    return f"{line}*{crc(line[1:])}"


# Six samples at 200 Hz over the end of week 2209. Counts z, -y, x of accelerometers, then of gyros, of an IMU with x right, y
# forward, z up: up 803 counts of 2^-14 m/s in 5 ms is 9.80 m/s^2; a turn to the left of 5 counts of 2^-19 rad.
lines = []
for k in range(6):
    week, second = (2209, 604799.985 + 0.005 * k) if k < 3 else (2210, 0.005 * (k - 3))
    counts = f"ea5afe00,{803 + k},{-20 - k},{3 + k},{5 + k},{7 + k},{-9 - k}"
    if k % 2 == 0:
        head = f"%RAWIMUSA,{week},{second:.3f}"
    else:
        head = f"#RAWIMUA,COM1,0,81.5,FINESTEERING,{week},{second:.3f},02000040,9cd7,16809"
    lines.append(message(head, f"{week},{second:.6f},{counts}"))
lines.insert(0, "# A comment of whoever wrote this log.")
lines.insert(2, message("%INSPVASA,2209,604799.985", "2209,604799.985000000,48.0,11.0,500.0,0.0,0.0,0.0,0.1,0.2,30.0,INS_SOLUTION_GOOD"))
lines.insert(4, "$GPGGA,000000.00,4800.0000,N,01100.0000,E,1,08,0.9,500.0,M,45.0,M,,*6A")
with open("rawimu.asc", "w") as file:
    file.write("\n".join(lines) + "\n")
