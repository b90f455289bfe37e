# Writes arrays as other programs do: write_arrays.py KIND FILE. 400 samples at 200 Hz; gyro_x counts 0, 1, 2, ...
import sys

import numpy

COUNT = 400
kind, path = sys.argv[1:3]
x = numpy.arange(COUNT, dtype=float)
gyro = numpy.column_stack([x, x + 0.25, x + 0.5])
acc = numpy.column_stack([0 * x, 0 * x, 9.8 + x / COUNT])
t = x / 200
words = kind.split("-")

if words[0] == "matlab5":
    from scipy.io import savemat

    arrays = {"t": t, "gyro": gyro, "acc": acc}
    if "rows" in words:  # as MATLAB's rows of samples
        arrays = {"t": t[None, :], "gyro": gyro.T, "acc": acc.T}
    if "rate" in words:
        arrays = {"fs": 200.0, "gyro": gyro.astype("float32"), "acc": acc, "note": "of a test", "bias": [0.1, 0.2]}
    if "struct" in words:
        arrays = {"imu": {"t": t, "gyro": gyro, "raw": {"acc": acc}}}
    if "counts" in words:
        arrays = {"fs": 200.0, "gyro": gyro[:, 0].astype("int16"), "acc": acc[:, 2]}
    savemat(path, arrays, do_compression="packed" in words, oned_as="column")
elif words[0] == "npy":  # time, rates and accelerations, channels by samples
    numpy.save(path, numpy.column_stack([t, gyro, acc]).T)
elif words[0] == "npz":
    save = numpy.savez_compressed if "packed" in words else numpy.savez
    if "matrix" in words:  # time, rates and accelerations in one array
        save(path, data=numpy.column_stack([t, gyro, acc]))
    elif "odd" in words:
        save(path, rate_hz=200, gyro_x=x.astype(">i4"), acc_z=numpy.asfortranarray(acc[:, 2]), name=numpy.array("imu"))
    else:
        save(path, t=t, gyro=gyro, acc=numpy.asfortranarray(acc))
elif words[0] == "matlab73":  # MATLAB has a block of the user's, columns as rows, and 1 x n for vectors
    import h5py

    with h5py.File(path, "w", userblock_size=512) as f:

        def put(group, name, array):
            group[name] = numpy.atleast_2d(array.T)
            group[name].attrs["MATLAB_class"] = numpy.bytes_("double")

        if "struct" in words:
            imu = f.create_group("imu")
            imu.attrs["MATLAB_class"] = numpy.bytes_("struct")
            put(imu, "t", t), put(imu, "gyro", gyro), put(imu, "acc", acc)
            f.create_group("#refs#")["a"] = numpy.arange(3)
        else:
            put(f, "fs", numpy.array([[200.0]])), put(f, "gyro", gyro), put(f, "acc", acc)
            f["note"] = numpy.frombuffer("of a test".encode("utf-16-le"), "uint16")[None, :]
            f["note"].attrs["MATLAB_class"] = numpy.bytes_("char")
    with open(path, "r+b") as f:
        f.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64")
elif words[0] == "hdf5":  # as h5py users write: samples times channels
    import h5py

    with h5py.File(path, "w") as f:
        f["time"] = t
        f["gyro"] = gyro
        f["acc"] = acc.astype("float32")
        f["gyro"].attrs["units"] = "deg/s"
