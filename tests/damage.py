"""What disks, crashes and careless hands do to files."""

import shutil

CONTENT = ("empty", "cut", "flip", "zeros", "longer", "random")
KINDS = (*CONTENT, "deleted", "directory")


def spoilt(data, chance, kind=None):
    """Content of a file, spoilt in a way that is named or drawn."""
    kind = kind or chance.choice(CONTENT)
    place = chance.randrange(len(data))
    if kind == "empty":
        return b""
    if kind == "cut":
        return data[:place]
    if kind == "flip":
        return data[:place] + bytes([data[place] ^ chance.randrange(1, 256)]) + data[place + 1 :]
    if kind == "zeros":
        return data[:place] + bytes(len(data) - place)  # as a crash leaves a file whose end was not written
    if kind == "longer":
        return data + chance.randbytes(chance.randrange(1, 100))
    return chance.randbytes(len(data))


def damage(file, chance, kind=None):
    """Spoil a file in its place."""
    data = file.read_bytes()
    kind = kind or chance.choice(KINDS)
    if kind in CONTENT:
        file.write_bytes(spoilt(data, chance, kind))
        return
    file.unlink()
    if kind == "directory":
        (file / "inner").mkdir(parents=True)


def misplace(first, second, chance):
    """Exchange two files, or put one in the place of the other, where both are still there."""
    if not (first.is_file() and second.is_file()):
        return
    one, other = first.read_bytes(), second.read_bytes()
    second.write_bytes(one)
    if chance.random() < 0.5:
        first.write_bytes(other)


def restore(file, data):
    """Put a file back as it was."""
    if file.is_dir():
        shutil.rmtree(file)
    file.write_bytes(data)
