"""Everything that is measured: ``make bench``."""

from benchmarks import kernel, service

if __name__ == "__main__":
    kernel.main()
    print()
    service.main()
