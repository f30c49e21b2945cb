  real(dp) function determinant(given)
    real(dp), intent(in) :: given(4, 4)
    real(dp) :: a(4, 4), row(4)
    integer :: i, j, pivot
    a = given
    determinant = 1
    do i = 1, 4
      pivot = i - 1 + maxloc(abs(a(i:4, i)), 1)
      if (pivot /= i) then
        row = a(i, :)
        a(i, :) = a(pivot, :)
        a(pivot, :) = row
        determinant = -determinant
      end if
      determinant = determinant*a(i, i)
      do j = i + 1, 4
        a(j, :) = a(j, :) - a(i, :)*a(j, i)/a(i, i)
      end do
    end do
  end function
