(** * Implicit-explicit steps of n modes

    The fast force F by the implicit midpoint rule over the whole step h, the slow force S by kicks, in mass-weighted coordinates; F and S are
    symmetric n x n matrices over any ordered field, N = 1 + h^2 F/4 is positive definite (so it is for every F >= 0).

    - [stable]    if 4 - h^2 S and F + S are positive definite, a positive definite form of two successive positions never changes: every orbit is
                  bounded, whatever F. No step is resonant;
    - [unstable]  if 4 - h^2 S is negative in some direction, some orbit has x N x >= x0 N x0 + delta k (k - 1) after k steps, delta > 0;
    - [unstable_total]  the same if F + S is;
    - [edge]      if 4 - h^2 S is semidefinite and its form vanishes at u, x_k = (-1)^k k u is an orbit: for u off 0 it grows step by step;
    - [edge_total]  if F + S is and does, x_k = k u is an orbit: a rigid motion.

    So the step is stable iff h^2 S < 4 and F + S > 0: at the edges, too, some orbit is unbounded.

    Words: form M x y == x^T M y, a number; definite M == the form of M is positive off 0; next == one step, from position and momentum;
    position k z == the position after k steps from z.                                        *)

Set Warnings "-notation-overridden,-ambiguous-paths".
From Coq Require Import Ring.
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** An identity of numbers that [twice] needs. *)
Section Numbers.
Variables (T : Type) (zero one : T) (add mul sub : T -> T -> T) (opp : T -> T).
Hypothesis laws : ring_theory zero one add mul sub opp (@eq T).
Add Ring Numbers : laws.
Local Notation "x + y" := (add x y).
Local Notation "x * y" := (mul x y).
Local Notation "x - y" := (sub x y).
Local Notation "- x" := (opp x).

Lemma any_scalars a b q e e1 f f1 c0 h0 g k H :
  b + c0 * e1 = a - c0 * e + h0 * (q - g * f) -> H = c0 + c0 + c0 + c0 -> h0 * g + h0 * g = H -> h0 * k = one + one ->
  b - c0 * e1 + h0 * (k * (b - a) - (q - g * f) - g * f1 - g * f1) - (b + c0 * e1) - (b + c0 * e1 - (a + c0 * e)) =
  - (H * e1 + H * f1).
Proof.
move=> eq fours halves two.
have kick : h0 * (q - g * f) = b + c0 * e1 - a + c0 * e by rewrite eq; ring.
have -> : b - c0 * e1 + h0 * (k * (b - a) - (q - g * f) - g * f1 - g * f1) - (b + c0 * e1) - (b + c0 * e1 - (a + c0 * e)) =
    b - c0 * e1 + (h0 * k) * (b - a) - h0 * (q - g * f) - (h0 * g + h0 * g) * f1 - (b + c0 * e1) -
    (b + c0 * e1 - (a + c0 * e)) by ring.
by rewrite kick two halves fours; ring.
Qed.

Lemma any_signs s p q r :
  - one * (- one * s) * p - - one * s * q - (- one * s * q - s * r) = s * (p - q - (q - r)) + s * (q + q + q + q).
Proof. ring. Qed.

Lemma any_start a b m : a - b + (m - a + b) = m.
Proof. ring. Qed.
End Numbers.

Section Words.
Variables (R : realFieldType) (n : nat).

Definition form (M : 'M[R]_n) (x y : 'cV[R]_n) : R := (x^T *m M *m y) 0 0.
Definition definite (M : 'M[R]_n) : Prop := forall x, x != 0 -> 0 < form M x x.

Variables (h : R) (F S : 'M[R]_n).
Definition mass : 'M[R]_n := 1%:M + (h ^+ 2 / 4%:R) *: F.

(** Half a slow kick, the midpoint rule (x' - x)/h = (p1 + p2)/2 and (p2 - p1)/h = - F (x + x')/2 solved for x' and p2, half a slow kick. *)
Definition next (z : 'cV[R]_n * 'cV[R]_n) :=
  let: (x, p) := z in
  let p1 := p - (h / 2%:R) *: (S *m x) in
  let x' := invmx mass *m (x - (h ^+ 2 / 4%:R) *: (F *m x) + h *: p1) in
  let p2 := (2%:R / h) *: (x' - x) - p1 in
  (x', p2 - (h / 2%:R) *: (S *m x')).

Definition position k z := (iter k next z).1.
End Words.

Section Proofs.
Variables (R : realFieldType) (n : nat).
Implicit Types (M N W : 'M[R]_n) (x y a b : 'cV[R]_n).

Lemma formDl M x y z : form M (x + y) z = form M x z + form M y z.
Proof. by rewrite /form linearD /= !mulmxDl mxE. Qed.

Lemma formDr M x y z : form M z (x + y) = form M z x + form M z y.
Proof. by rewrite /form mulmxDr mxE. Qed.

Lemma formNl M x y : form M (- x) y = - form M x y.
Proof. by rewrite /form linearN /= !mulNmx mxE. Qed.

Lemma formNr M x y : form M x (- y) = - form M x y.
Proof. by rewrite /form mulmxN mxE. Qed.

Lemma formZl M c x y : form M (c *: x) y = c * form M x y.
Proof. by rewrite /form linearZ /= -!scalemxAl mxE. Qed.

Lemma formZr M c x y : form M x (c *: y) = c * form M x y.
Proof. by rewrite /form -scalemxAr mxE. Qed.

Lemma formC M x y : M^T = M -> form M x y = form M y x.
Proof.
move=> sym; rewrite /form.
have -> : (x^T *m M *m y) 0 0 = ((x^T *m M *m y)^T) 0 0 by rewrite [RHS]mxE.
by rewrite !trmx_mul trmxK sym mulmxA.
Qed.

Lemma form_moved M N x y z : M *m x = N *m y -> form M z x = form N z y.
Proof. by move=> same; rewrite /form -!mulmxA same. Qed.

Lemma definite_ge0 M x : definite M -> 0 <= form M x x.
Proof.
move=> pos; have [->|x0] := eqVneq x 0; last exact: ltW (pos x x0).
by rewrite /form mulmx0 mxE.
Qed.

Lemma definite_unit M : M^T = M -> definite M -> M \in unitmx.
Proof.
move=> sym pos; rewrite -row_free_unit -kermx_eq0; apply/negPn/negP => /rowV0Pn [u].
move/sub_kermxP=> uM u0; have u0' : u^T != 0 by rewrite -trmx0 (inj_eq (@trmx_inj _ _ _)).
by have := pos _ u0'; rewrite /form trmxK uM mul0mx mxE ltxx.
Qed.

Let ring_laws : @ring_theory (GRing.Zmodule.sort R) 0 1 +%R *%R (fun u v : R => u - v) -%R (@eq (GRing.Zmodule.sort R)).
Proof.
by split=> *; rewrite ?add0r ?mul1r ?addrA ?mulrA ?mulrDl ?subrr //; [rewrite addrC|rewrite mulrC].
Qed.
Let same_laws : @ring_theory (Num.RealField.sort R) 0 1 +%R *%R (fun u v : R => u - v) -%R (@eq (Num.RealField.sort R)).
Proof. exact: ring_laws. Qed.
Add Ring Group : ring_laws.
Add Ring Field : same_laws.

Let le_by (p q : R) : p = q -> 0 <= p -> 0 <= q.
Proof. by move->. Qed.

(** * N (y+ + y-) = 2 N y - W y, in the differences a = y+ - y and b = y - y- *)

Section Recurrence.
Variables (N W : 'M[R]_n) (y a b : 'cV[R]_n).
Hypotheses (Nsym : N^T = N) (Wsym : W^T = W).
Hypothesis recurrence : N *m (a - b) = - (W *m y).

Lemma force z : form N z (a - b) = - form W z y.
Proof. by rewrite /form -!mulmxA recurrence mulmxN [LHS]mxE. Qed.

(** The energy before and after. *)
Lemma energy : form N a a + form W (y + a) y = form N b b + form W (y - b) y.
Proof.
have := force (a + b); rewrite !(formDl, formDr, formNl, formNr) (formC b a Nsym).
move: (form N a a) (form N a b) (form N b b) (form W a y) (form W b y) (form W y y).
move=> naa nab nbb wa wb wy same.
have -> : naa = nbb - (wa + wb) by rewrite -same; ring.
ring.
Qed.

(** The second difference of the form of N. *)
Lemma convex :
  form N (y + a) (y + a) + form N (y - b) (y - b) =
  form N y y + form N y y + form N (a + b) (a + b) - (form N a a + form W (y + a) y) - (form N a a + form W (y + a) y).
Proof.
have := force (a - b); have := force (a + b); have := force y.
rewrite !(formDl, formDr, formNl, formNr) (formC b a Nsym) (formC a y Nsym) (formC b y Nsym).
move: (form N a a) (form N a b) (form N b b) (form W a y) (form W b y) (form W y y) (form N y a) (form N y b) (form N y y).
move=> naa nab nbb wa wb wy nya nyb nyy ey sum difference.
have -> : nya = nyb - wy by rewrite -ey; ring.
have twice : wa + wa = nab + nab - (naa + naa).
  have -> : wa + wa = - (- (wa + wb) + - (wa - wb)) by ring.
  by rewrite -sum -difference; ring.
have -> : naa + (wy + wa) = (naa + wy) + wa by ring.
set e := naa + wy.
have -> : nyy + nyy + (naa + nab + (nab + nbb)) - (e + wa) - (e + wa) =
          nyy + nyy + (naa + nab + (nab + nbb)) - (e + e) - (wa + wa) by ring.
by rewrite twice /e; ring.
Qed.
End Recurrence.

(** * Orbits: N (x+ + x-) = 2 N x - W x at every step *)

Section Orbit.
Variables (N W : 'M[R]_n) (x : nat -> 'cV[R]_n).
Hypotheses (Nsym : N^T = N) (Wsym : W^T = W).
Let d k := x k.+1 - x k.
Hypothesis recurrence : forall k, N *m (d k.+1 - d k) = - (W *m x k.+1).

Definition level k := form N (d k) (d k) + form W (x k.+1) (x k).

Lemma ahead k : x k.+1 + d k.+1 = x k.+2.
Proof. by rewrite /d addrC subrK. Qed.

Lemma behind k : x k.+1 - d k = x k.
Proof. by rewrite /d opprB addrC subrK. Qed.

Lemma conserved k : level k = level 0%N.
Proof.
elim: k => // k <-; rewrite /level -(ahead k) (energy Nsym (recurrence k)) (behind k).
by rewrite (formC (x k) _ Wsym).
Qed.

(** Four times the level is a sum of two forms. *)
Lemma split_level k :
  level k *+ 4 = form (N *+ 4 - W) (d k) (d k) + form W (x k.+1 + x k) (x k.+1 + x k).
Proof.
have formB M M' y z : form (M - M') y z = form M y z - form M' y z.
  by rewrite /form mulmxBr mulmxBl !mxE.
have form4 M y z : form (M *+ 4) y z = form M y z *+ 4.
  by rewrite -scaler_nat /form -scalemxAr -scalemxAl mxE mulr_natl.
rewrite formB form4 /level mulrnDl -addrA; congr (_ + _).
rewrite !(formDl, formDr, formNl, formNr) (formC (x k) (x k.+1) Wsym) !mulrS mulr0n.
by move: (form W _ _) (form W _ _) (form W _ _) => p q r; ring.
Qed.

Hypothesis pos : definite N.

Lemma growth : x 1%N = x 0%N ->
  forall k, form N (x 0%N) (x 0%N) - form W (x 0%N) (x 0%N) * (k * k.-1)%:R <= form N (x k) (x k).
Proof.
move=> start.
have level0 k : level k = form W (x 0%N) (x 0%N).
  by rewrite conserved /level /d start subrr /form mulmx0 mxE add0r.
pose phi k := form N (x k) (x k); pose delta := - form W (x 0%N) (x 0%N).
have second k : phi k.+1 + phi k.+1 + delta + delta <= phi k.+2 + phi k.
  have := convex Nsym (recurrence k); rewrite (ahead k) (behind k) /phi => ->.
  rewrite -/(level k.+1) level0 -/delta -subr_ge0.
  apply: le_by (definite_ge0 (d k.+1 + d k) pos); rewrite /delta.
  have same (p q r : R) : q = p + p + q - r - r - (p + p - r - r) by ring.
  exact: same.
have first k : phi k + delta *+ (2 * k) <= phi k.+1.
  elim: k => [|k ind]; first by rewrite muln0 mulr0n addr0 /phi start.
  have := second k; rewrite -ler_subl_addr; apply: le_trans.
  rewrite -subr_ge0; move: ind; rewrite -subr_ge0; apply: le_by.
  have same (p q e t : R) : q - (p + t) = q + q + e + e - p - (q + (e + e + t)) by ring.
  rewrite mulnS mulrnDr mulr2n; exact: same.
have le k : phi 0%N + delta * (k * k.-1)%:R <= phi k.
  elim: k => [|k ind]; first by rewrite mul0n mulr0 addr0.
  apply: le_trans (first k); rewrite -subr_ge0; move: ind; rewrite -subr_ge0; apply: le_by.
  have -> : (k.+1 * k.+1.-1)%N = (k * k.-1 + 2 * k)%N.
    by case: (k) => //= j; rewrite (mulnC j.+1 j) -mulnDl addn2.
  have same (p q e s t : R) : q - (p + e * s) = q + e * t - (p + e * (s + t)) by ring.
  rewrite natrD -[delta *+ _]mulr_natr; exact: same.
by move=> k; have := le k; rewrite /phi /delta mulNr.
Qed.
End Orbit.

(** * Implicit-explicit steps *)

Section Steps.
Variables (h : R) (F S : 'M[R]_n).
Hypotheses (h_pos : 0 < h) (Fsym : F^T = F) (Ssym : S^T = S).
Let N := mass h F.
Hypothesis N_pos : definite N.

(** The stiffness of both, and the slow one below its limit. *)
Definition total : 'M[R]_n := h ^+ 2 *: (F + S).
Definition room : 'M[R]_n := 4%:R%:M - h ^+ 2 *: S.

Let c := h ^+ 2 / 4%:R.

Lemma Nsym : N^T = N.
Proof. by rewrite /N /mass linearD linearZ /= trmx1 Fsym. Qed.

Lemma total_sym : total^T = total.
Proof. by rewrite /total linearZ linearD /= Fsym Ssym. Qed.

Lemma room_sym : room^T = room.
Proof. by rewrite /room linearB linearZ /= tr_scalar_mx Ssym. Qed.

Lemma room_total : N *+ 4 - total = room.
Proof.
rewrite /N /mass /total /room mulrnDl -[_ *: F *+ 4]scaler_nat scalerA scalerDr.
by rewrite mulrC divfK ?pnatr_eq0 // opprD addrA addrK -scaler_nat scalemx1.
Qed.

(** One step, without the inverse. *)
Lemma stepped x p : let: (x', p') := next h F S (x, p) in
  N *m x' = x - c *: (F *m x) + h *: (p - (h / 2%:R) *: (S *m x)).
Proof. by rewrite /next mulKVmx // definite_unit // Nsym. Qed.

Lemma scalars (a b q e e1 f f1 c0 h0 g k H : R) :
  b + c0 * e1 = a - c0 * e + h0 * (q - g * f) -> H = c0 + c0 + c0 + c0 -> h0 * g + h0 * g = H -> h0 * k = 1 + 1 ->
  b - c0 * e1 + h0 * (k * (b - a) - (q - g * f) - g * f1 - g * f1) - (b + c0 * e1) - (b + c0 * e1 - (a + c0 * e)) =
  - (H * e1 + H * f1).
Proof. exact: (any_scalars ring_laws). Qed.

(** Two steps. *)
Theorem twice x p :
  let: z := next h F S (x, p) in let: x' := z.1 in let: x'' := (next h F S z).1 in
  N *m (x'' - x' - (x' - x)) = - (total *m x').
Proof.
have first := stepped x p; move: first (stepped (next h F S (x, p)).1 (next h F S (x, p)).2).
rewrite /next /=; set x' := invmx _ *m _ => first; clearbody x'; set p' := _ - _ - _; set x'' := invmx _ *m _ => second.
have h0 : h != 0 by rewrite gt_eqF.
have two : h * (2%:R / h) = 2%:R by rewrite mulrC divfK.
have Nx y : N *m y = y + c *: (F *m y) by rewrite /N /mass mulmxDl mul1mx -scalemxAl.
have total_x : total *m x' = h ^+ 2 *: (F *m x') + h ^+ 2 *: (S *m x').
  by rewrite /total -scalemxAl mulmxDl scalerDr.
rewrite !mulmxBr total_x second (Nx x) {second x''}.
have := first; rewrite (Nx x') /p'.
move: (F *m x) (F *m x') (S *m x) (S *m x') => u v w w' start.
apply/matrixP=> i j; move: (congr1 (fun m : 'cV_n => m i j) start); rewrite !mxE.
move: (x i j) (x' i j) (p i j) (u i j) (v i j) (w i j) (w' i j) => a b q e e1 f f1 eq.
have fours : h ^+ 2 = c + c + c + c.
  have <- : c *+ 4 = h ^+ 2 by rewrite -mulr_natr /c divfK ?pnatr_eq0.
  by rewrite !mulrS mulr0n addr0 !addrA.
have halves : h * (h / 2%:R) + h * (h / 2%:R) = h ^+ 2.
  by rewrite -mulr2n -mulr_natr -mulrA divfK ?pnatr_eq0 // expr2.
by apply: scalars; rewrite // two.
Qed.

Let x z k := position h F S k z.

Lemma orbit z k : N *m (x z k.+2 - x z k.+1 - (x z k.+1 - x z k)) = - (total *m x z k.+1).
Proof. by rewrite /x /position /=; case: (iter k _ z) => a b; have := twice a b; case: (next _ _ _ _). Qed.

(** The same in turns of sign. *)
Lemma alternating z k :
  N *m ((-1) ^+ k.+2 *: x z k.+2 - (-1) ^+ k.+1 *: x z k.+1 - ((-1) ^+ k.+1 *: x z k.+1 - (-1) ^+ k *: x z k)) =
  - (room *m ((-1) ^+ k.+1 *: x z k.+1)).
Proof.
have same : (-1) ^+ k.+2 *: x z k.+2 - (-1) ^+ k.+1 *: x z k.+1 - ((-1) ^+ k.+1 *: x z k.+1 - (-1) ^+ k *: x z k) =
    (-1) ^+ k *: (x z k.+2 - x z k.+1 - (x z k.+1 - x z k) + (x z k.+1 + x z k.+1 + x z k.+1 + x z k.+1)).
  by apply/matrixP=> i j; rewrite scalerDr !exprS !mxE; exact: (any_signs ring_laws).
rewrite same -scalemxAr mulmxDr orbit -room_total exprS mulN1r scaleNr mulmxN opprK -scalemxAr mulmxBl.
congr (_ *: _); rewrite addrC; congr (_ - _).
by rewrite !mulmxDr !mulrS mulr0n addr0 !mulmxDl !addrA.
Qed.

(** Two forms of successive positions, whose sum never changes; where they are definite every orbit stays bounded. *)
Theorem stable z k : definite room -> definite (F + S) ->
  let slow k := form room (x z k.+1 - x z k) (x z k.+1 - x z k) in
  let whole k := form total (x z k.+1 + x z k) (x z k.+1 + x z k) in
  [/\ slow k + whole k = slow 0%N + whole 0%N, 0 <= slow k & 0 <= whole k].
Proof.
move=> room_pos total_pos slow whole; split.
- by rewrite /slow /whole -room_total -!(split_level N (x z) total_sym) (conserved Nsym total_sym (orbit z)).
- exact: definite_ge0.
have -> : whole k = h ^+ 2 * form (F + S) (x z k.+1 + x z k) (x z k.+1 + x z k).
  by rewrite /whole /total /form -scalemxAr -scalemxAl mxE.
by apply: mulr_ge0; [rewrite exprn_ge0 // ltW | exact: definite_ge0].
Qed.

(** Orbits that begin with two given positions. *)
Lemma started u v : exists2 z, x z 0%N = u & x z 1%N = v.
Proof.
have h0 : h != 0 by rewrite gt_eqF.
exists (u, h^-1 *: (N *m v - u + c *: (F *m u)) + (h / 2%:R) *: (S *m u)) => //.
rewrite /x /position /= addrK scalerA divff // scale1r.
have -> : u - (h ^+ 2 / 4%:R) *: (F *m u) + (N *m v - u + c *: (F *m u)) = N *m v.
  rewrite -/c; move: (N *m v) (c *: _) => m b; apply/matrixP=> i j; rewrite !mxE; exact: (any_start ring_laws).
by rewrite mulKmx // definite_unit // Nsym.
Qed.

(** Where 4 - h^2 S is negative in a direction, an orbit grows. *)
Theorem unstable u : form room u u < 0 ->
  exists z, position h F S 0 z = u /\
    forall k, form N u u - form room u u * (k * k.-1)%:R <= form N (position h F S k z) (position h F S k z).
Proof.
move=> neg; have [z first second] := started u (- u); exists z; split=> // k.
pose y k := (-1) ^+ k *: x z k.
have y0 : y 0%N = u by rewrite /y expr0 scale1r first.
have y1 : y 1%N = y 0%N by rewrite y0 /y expr1 scaleN1r second opprK.
have := @growth N room y Nsym room_sym (alternating z) N_pos y1 k.
rewrite y0 /y formZl formZr mulrA -exprMn mulrNN mulr1 expr1n mul1r; exact.
Qed.

(** The same where F + S is: the molecule itself is no minimum. *)
Theorem unstable_total u : form (F + S) u u < 0 ->
  exists z, position h F S 0 z = u /\
    forall k, form N u u - h ^+ 2 * form (F + S) u u * (k * k.-1)%:R <=
      form N (position h F S k z) (position h F S k z).
Proof.
move=> neg; have [z first second] := started u u; exists z; split=> // k.
have same : x z 1%N = x z 0%N by rewrite first second.
have := @growth N total (x z) Nsym total_sym (orbit z) N_pos same k; rewrite first.
have -> : form total u u = h ^+ 2 * form (F + S) u u by rewrite /total /form -scalemxAr -scalemxAl mxE.
exact.
Qed.

(** At the edge, 4 - h^2 S or F + S with a null direction, an orbit moves along it by the same displacement at every step. *)

(** The null directions of a semidefinite form are those of its matrix. *)
Lemma null_direction W u : W^T = W -> (forall y, 0 <= form W y y) -> form W u u = 0 -> W *m u = 0.
Proof.
move=> sym semi zero; pose y := W *m u.
have square : form W y u = form 1%:M y y by rewrite /form mulmx1 -[in LHS]mulmxA.
have definite1 : definite (1%:M : 'M[R]_n).
  move=> v v0; rewrite /form mulmx1 mxE lt_def sumr_ge0 ?andbT => [|i _]; last by rewrite mxE -expr2 sqr_ge0.
  apply: contra v0 => /eqP sum; apply/eqP/matrixP=> i j; rewrite ord1 mxE.
  have /eqP : v i 0 ^+ 2 = 0.
    have ge0 k : true -> 0 <= v k 0 ^+ 2 by rewrite sqr_ge0.
    apply: (psumr_eq0P ge0) => //; rewrite -[RHS]sum; apply: eq_bigr => k _; by rewrite mxE expr2.
  by rewrite expf_eq0 /= => /eqP.
have [//|y0] := eqVneq y 0.
have pos := definite1 _ y0; rewrite -square in pos.
pose t := - ((form W y y + 1) / (form W y u + form W y u)).
have := semi (y + t *: u).
rewrite !(formDl, formDr, formZl, formZr) zero !mulr0 addr0 (formC u y sym) -addrA -mulrDr.
have c0 : form W y u + form W y u != 0 by rewrite gt_eqF // addr_gt0.
rewrite /t mulNr divfK // opprD addrA subrr add0r oppr_ge0 => le0.
by have := lt_le_trans ltr01 le0; rewrite ltxx.
Qed.

Lemma straight W (y : nat -> 'cV[R]_n) u :
  (forall k, N *m (y k.+2 - y k.+1 - (y k.+1 - y k)) = - (W *m y k.+1)) ->
  W *m u = 0 -> y 0%N = 0 -> y 1%N = u -> forall k, y k = k%:R *: u.
Proof.
move=> recurrence null y0 y1 k.
suff [] : y k = k%:R *: u /\ y k.+1 = k.+1%:R *: u by [].
elim: k => [|k [yk yk1]]; first by rewrite y0 y1 scale0r scale1r.
split=> //.
have := recurrence k; rewrite yk1 -scalemxAr null scaler0 oppr0 => zero.
have : y k.+2 - k.+1%:R *: u - (k.+1%:R *: u - y k) = 0.
  by rewrite -[LHS](mulKmx (definite_unit Nsym N_pos)) zero mulmx0.
move/eqP; rewrite subr_eq0 subr_eq => /eqP ->.
by rewrite yk -scalerBl -scalerDl -natrB ?leqnSn // subSnn -natrD add1n.
Qed.

Theorem edge u : (forall y, 0 <= form room y y) -> form room u u = 0 ->
  exists z, forall k, position h F S k z = ((-1) ^+ k * k%:R) *: u.
Proof.
move=> semi zero; have null := null_direction room_sym semi zero.
have [z first second] := started 0 (- u); exists z => k.
pose y k := (-1) ^+ k *: x z k.
have y0 : y 0%N = 0 by rewrite /y first scaler0.
have y1 : y 1%N = u by rewrite /y second expr1 scaleN1r opprK.
have := straight (alternating z) null y0 y1 k; rewrite /y => turned.
by rewrite -scalerA -turned scalerA -exprMn mulrNN mulr1 expr1n scale1r.
Qed.

Theorem edge_total u : (forall y, 0 <= form (F + S) y y) -> form (F + S) u u = 0 ->
  exists z, forall k, position h F S k z = k%:R *: u.
Proof.
move=> semi zero.
have same y : form total y y = h ^+ 2 * form (F + S) y y by rewrite /total /form -scalemxAr -scalemxAl mxE.
have null : total *m u = 0.
  apply: (null_direction total_sym) => [y|]; last by rewrite same zero mulr0.
  by rewrite same mulr_ge0 // exprn_ge0 // ltW.
have [z first second] := started 0 u; exists z => k.
exact: straight (orbit z) null first second k.
Qed.
End Steps.
End Proofs.
