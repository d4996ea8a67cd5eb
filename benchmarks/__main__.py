"""All benchmarks, one after the other: ``make bench``."""

from benchmarks import kernel, laboratory, patchwork, service, worker

if __name__ == "__main__":
    kernel.main()
    print()
    laboratory.main()
    print()
    patchwork.main()
    print()
    worker.main()
    print()
    service.main()
