"""Everything that is measured: ``make bench``."""

from benchmarks import kernel, laboratory, service

if __name__ == "__main__":
    kernel.main()
    print()
    laboratory.main()
    print()
    service.main()
